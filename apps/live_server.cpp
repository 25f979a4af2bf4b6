#include <locograph/apps/live_server.h>
#include <locograph/common/deadline.h>
#include <locograph/common/error.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <csignal>
#include <list>
#include <thread>

namespace locograph {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

constexpr std::size_t kMostConnections = 32;
constexpr int kRequestTimeout_ms = 10000;
constexpr std::size_t kLongestMessage = 4096;

/// One client: its socket and the thread that answers it.
struct Connection {
  explicit Connection(tcp::socket accepted) : socket(std::move(accepted)) {}
  tcp::socket socket;
  std::atomic<bool> done = false;
  std::thread thread;
};

/// What the connections' threads share, all of it constant but `stopping`.
struct Site {
  std::string page;
  LiveServer::Session session;
  int port = 0;
  std::atomic<bool> stopping = false;

  bool is_own_host(beast::string_view host) const {
    const std::string suffix = ":" + std::to_string(port);
    return host == "127.0.0.1" + suffix || host == "localhost" + suffix;
  }
  bool is_own_origin(beast::string_view origin) const {
    return origin.starts_with("http://") && is_own_host(origin.substr(7));
  }
};

class WebSocketChannel final : public LiveChannel {
 public:
  WebSocketChannel(beast::websocket::stream<tcp::socket&>& stream, const Site& site)
      : stream_(stream), site_(site) {}

  bool send(const std::string& text) override {
    if (site_.stopping) return false;
    beast::error_code failed;
    stream_.text(true);
    stream_.write(asio::buffer(text), failed);
    return !failed;
  }

  bool wait(double seconds) override {
    const Deadline deadline = Deadline::after(seconds);
    while (!deadline.passed()) {
      if (site_.stopping) return false;
      std::this_thread::sleep_for(std::chrono::duration<double>(std::min(seconds, 0.02)));
    }
    return !site_.stopping;
  }

 private:
  beast::websocket::stream<tcp::socket&>& stream_;
  const Site& site_;
};

using Request = http::request<http::string_body>;

void respond(tcp::socket& socket, const Request& request, http::status status,
             const std::string& type, const std::string& body) {
  http::response<http::string_body> response(status, request.version());
  response.set(http::field::content_type, type);
  response.set(http::field::cache_control, "no-store");
  response.keep_alive(false);
  response.body() = body;
  response.prepare_payload();
  if (request.method() == http::verb::head) response.body().clear();
  http::serializer<false, http::string_body> serializer(response);
  beast::error_code failed;
  if (request.method() == http::verb::head) {
    http::write_header(socket, serializer, failed);
  } else {
    http::write(socket, serializer, failed);
  }
}

void answer_live(tcp::socket& socket, const Request& request, const Site& site) {
  beast::websocket::stream<tcp::socket&> stream(socket);
  beast::error_code failed;
  stream.accept(request, failed);
  if (failed) return;
  WebSocketChannel channel(stream, site);
  site.session(channel);
  // A page that loses its connection makes another one: it is the client who leaves.
  stream.read_message_max(kLongestMessage);
  beast::flat_buffer ignored;
  while (!failed && !site.stopping) {
    stream.read(ignored, failed);
    ignored.clear();
  }
  stream.close(site.stopping ? beast::websocket::close_code::going_away
                             : beast::websocket::close_code::normal,
               failed);
}

void answer(tcp::socket& socket, const Site& site) {
  pollfd readable = {socket.native_handle(), POLLIN, 0};
  if (::poll(&readable, 1, kRequestTimeout_ms) <= 0) return;
  beast::flat_buffer buffer;
  Request request;
  beast::error_code failed;
  http::read(socket, buffer, request, failed);
  if (failed) return;
  const std::string plain = "text/plain; charset=utf-8";
  const beast::string_view origin = request[http::field::origin];
  const std::string path(request.target().substr(0, request.target().find_first_of("?#")));
  if (!site.is_own_host(request[http::field::host]) ||
      (!origin.empty() && !site.is_own_origin(origin))) {
    respond(socket, request, http::status::forbidden, plain, "not for other sites\n");
  } else if (path == "/live" && beast::websocket::is_upgrade(request)) {
    answer_live(socket, request, site);
  } else if (request.method() != http::verb::get && request.method() != http::verb::head) {
    respond(socket, request, http::status::method_not_allowed, plain, "GET only\n");
  } else if (path == "/") {
    respond(socket, request, http::status::ok, "text/html; charset=utf-8", site.page);
  } else {
    respond(socket, request, http::status::not_found, plain, "not here: see /\n");
  }
}

}  // namespace

struct LiveServer::State {
  Site site;
  asio::io_context context{1};
  tcp::acceptor acceptor{context};
  asio::signal_set signals{context, SIGINT, SIGTERM};
  std::list<Connection> connections;

  void accept() {
    acceptor.async_accept([this](beast::error_code failed, tcp::socket socket) {
      if (!acceptor.is_open()) return;
      if (!failed) serve(std::move(socket));
      accept();
    });
  }

  void serve(tcp::socket socket) {
    reap();
    if (connections.size() >= kMostConnections) return;
    Connection& connection = connections.emplace_back(std::move(socket));
    connection.thread = std::thread([this, &connection] {
      try {
        answer(connection.socket, site);
      } catch (const std::exception&) {
        // Out of memory, say: this client gets no answer, the others do.
      }
      // The socket is closed by reap(), in the thread that may shut it down.
      ::shutdown(connection.socket.native_handle(), SHUT_RDWR);
      connection.done = true;
    });
  }

  void reap() {
    connections.remove_if([](Connection& connection) {
      if (!connection.done) return false;
      connection.thread.join();
      return true;
    });
  }

  void stop() {
    site.stopping = true;
    beast::error_code ignored;
    acceptor.close(ignored);
    signals.cancel(ignored);
  }

  void join() {
    for (Connection& connection : connections) {
      ::shutdown(connection.socket.native_handle(), SHUT_RDWR);
    }
    for (Connection& connection : connections) connection.thread.join();
    connections.clear();
  }
};

LiveServer::LiveServer(int port, std::string page, Session session)
    : state_(std::make_unique<State>()) {
  try {
    const tcp::endpoint loopback(asio::ip::address_v4::loopback(),
                                 static_cast<unsigned short>(port));
    state_->acceptor.open(loopback.protocol());
    state_->acceptor.set_option(tcp::acceptor::reuse_address(true));
    state_->acceptor.bind(loopback);
    state_->acceptor.listen();
  } catch (const boost::system::system_error& failure) {
    throw Error("port " + std::to_string(port) + " cannot be used: " + failure.code().message(),
                "a free port, or 0 for any");
  }
  state_->site.page = std::move(page);
  state_->site.session = std::move(session);
  state_->site.port = state_->acceptor.local_endpoint().port();
}

LiveServer::~LiveServer() {
  state_->stop();
  state_->join();
}

int LiveServer::port() const { return state_->site.port; }
std::string LiveServer::address() const {
  return "http://127.0.0.1:" + std::to_string(port()) + "/";
}

void LiveServer::run() {
  state_->signals.async_wait([this](beast::error_code failed, int) {
    if (!failed) state_->stop();
  });
  state_->accept();
  state_->context.run();
  state_->join();
}

}  // namespace locograph
