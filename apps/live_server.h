#pragma once
/// A small HTTP and WebSocket server on 127.0.0.1: one page, and a live stream beside it.
///
///     LiveServer server(8080, page, [](LiveChannel& channel) {
///       while (channel.send("{…}") && channel.wait(0.1)) {}
///     });
///     std::cout << server.address() << '\n';         // http://127.0.0.1:8080/
///     server.run();                                   // until SIGINT or SIGTERM
///
/// GET / answers the page; a WebSocket at /live runs the session in a thread of its own and
/// stays open until the client leaves. Listens on the loopback interface only, and refuses requests
/// that a foreign page makes in the user's browser (Host and Origin must be this server).

#include <functional>
#include <memory>
#include <string>

namespace locograph {

/// A session's end of a WebSocket.
class LiveChannel {
 public:
  virtual ~LiveChannel() = default;
  /// False when the client is gone or the server stops: the session should return.
  virtual bool send(const std::string& text) = 0;
  /// Sleeps; false as above.
  virtual bool wait(double seconds) = 0;
};

class LiveServer {
 public:
  using Session = std::function<void(LiveChannel&)>;

  /// port 0: any free one. Throws Error when the port cannot be used.
  LiveServer(int port, std::string page, Session session);
  ~LiveServer();

  int port() const;
  std::string address() const;
  /// Serves until SIGINT or SIGTERM; sessions have returned then.
  void run();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace locograph
