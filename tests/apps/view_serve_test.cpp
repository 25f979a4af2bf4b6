#include <apps/view_test_support.h>
#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

namespace locograph {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;

/// For what does not come: far longer than any machine needs.
constexpr int kMostWait_ms = 600000;

/// `locograph view … --serve 0`, ended by SIGINT.
class Served {
 public:
  explicit Served(const CommandRunner& runner, const std::string& more) {
    int pipe_ends[2];
    if (::pipe(pipe_ends) != 0) throw std::runtime_error("no pipe");
    child_ = ::fork();
    if (child_ == 0) {
      ::dup2(pipe_ends[1], 1);
      ::close(pipe_ends[0]);
      ::close(pipe_ends[1]);
      const std::string line =
          "cd '" + runner.folder().string() +
          "' && exec '" LOCOGRAPH_COMMAND "' view p.g2o --no-check --serve 0 " + more;
      ::execl("/bin/sh", "sh", "-c", line.c_str(), static_cast<char*>(nullptr));
      ::_exit(127);
    }
    ::close(pipe_ends[1]);
    out_ = pipe_ends[0];
    std::string text;
    for (char c = 0; text.find('\n') == std::string::npos;) {
      pollfd readable = {out_, POLLIN, 0};
      if (::poll(&readable, 1, kMostWait_ms) <= 0 || ::read(out_, &c, 1) != 1) break;
      text += c;
    }
    const std::string before = "http://127.0.0.1:";
    const std::size_t at = text.find(before);
    if (at != std::string::npos) port = std::stoi(text.substr(at + before.size()));
  }
  ~Served() {
    if (child_ > 0) stop();
    ::close(out_);
  }
  /// Exit code.
  int stop() {
    ::kill(child_, SIGINT);
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  int port = 0;

 private:
  pid_t child_ = -1;
  int out_ = -1;
};

tcp::socket connect(asio::io_context& context, int port) {
  tcp::socket socket(context);
  socket.connect({asio::ip::address_v4::loopback(), static_cast<unsigned short>(port)});
  return socket;
}

beast::http::response<beast::http::string_body> get(int port, const std::string& target,
                                                    const std::string& host) {
  asio::io_context context;
  tcp::socket socket = connect(context, port);
  beast::http::request<beast::http::empty_body> request(beast::http::verb::get, target, 11);
  request.set(beast::http::field::host, host);
  beast::http::write(socket, request);
  beast::flat_buffer buffer;
  beast::http::response_parser<beast::http::string_body> parser;
  parser.body_limit(64 * 1024 * 1024);
  beast::http::read(socket, buffer, parser);
  return parser.release();
}

class Live : public ViewPlan {
 protected:
  using Stream = beast::websocket::stream<tcp::socket>;
  std::unique_ptr<Stream> connect_live(int port) {
    auto stream = std::make_unique<Stream>(connect(context_, port));
    stream->handshake("127.0.0.1:" + std::to_string(port), "/live");
    return stream;
  }
  static nlohmann::json receive(Stream& stream) {
    beast::flat_buffer buffer;
    stream.read(buffer);
    return nlohmann::json::parse(beast::buffers_to_string(buffer.data()));
  }
  asio::io_context context_;
};

TEST_F(Live, PageIsServedAndTheRestIsNot) {
  Served served(runner, "");
  ASSERT_GT(served.port, 0);
  const std::string host = "127.0.0.1:" + std::to_string(served.port);
  const auto page = get(served.port, "/", host);
  EXPECT_EQ(page.result_int(), 200u);
  EXPECT_EQ(scene_of(page.body())["live"], "/live");
  EXPECT_EQ(get(served.port, "/etc/passwd", host).result_int(), 404u);
  EXPECT_EQ(get(served.port, "/", "evil.example").result_int(), 403u);
  EXPECT_EQ(served.stop(), 0);
}

TEST_F(Live, EveryCycleArrivesAndTheEndIsTold) {
  runner.write("aside.xml",
               "<obstacles version=\"1\">\n"
               "<box name=\"aside\" center=\"2 1.2 0.25\" size=\"0.4 0.4 0.5\"/>\n</obstacles>\n");
  Served served(runner, "--speed 1000 --obstacles aside.xml");
  ASSERT_GT(served.port, 0);
  const auto stream = connect_live(served.port);
  const nlohmann::json start = receive(*stream);
  EXPECT_EQ(start["type"], "start");
  EXPECT_EQ(start["count"], 50);
  int cycles = 0;
  nlohmann::json message;
  for (message = receive(*stream); message["type"] == "cycle"; message = receive(*stream)) {
    EXPECT_EQ(message["executed"], cycles);
    const nlohmann::json& changed = message["configurations"];
    EXPECT_EQ(changed.size(), message["window"].get<std::size_t>() + 1);
    EXPECT_EQ(changed[std::to_string(cycles)].size(), 31u);
    ++cycles;
  }
  EXPECT_EQ(message["type"], "end");
  EXPECT_TRUE(message["success"]) << message;
  EXPECT_EQ(cycles, 49);
}

TEST_F(Live, TellsWhatCamerasSawSinceTheLastCycle) {
  runner.write("aside.xml",
               "<obstacles version=\"1\">\n"
               "<box name=\"aside\" center=\"2 1.2 0.25\" size=\"0.4 0.4 0.5\"/>\n</obstacles>\n");
  Served served(runner, "--speed 1000 --obstacles aside.xml --cameras --camera-rate 3");
  ASSERT_GT(served.port, 0);
  const std::string host = "127.0.0.1:" + std::to_string(served.port);
  const nlohmann::json blank = scene_of(get(served.port, "/", host).body())["perception"];
  EXPECT_EQ(blank["cameras"].size(), 2u);
  EXPECT_TRUE(blank["clouds"].empty()) << "they come with the run";
  const auto stream = connect_live(served.port);
  EXPECT_EQ(receive(*stream)["type"], "start");
  double last_s = -1.0;
  nlohmann::json message;
  for (message = receive(*stream); message["type"] == "cycle"; message = receive(*stream)) {
    const nlohmann::json& seen = message["perception"];
    ASSERT_EQ(seen["clouds"].size(), 2u);
    ASSERT_EQ(seen["maps"].size(), 1u);
    EXPECT_GT(seen["clouds"][0]["stamp"], last_s);
    EXPECT_GE(seen["maps"][0]["time"], seen["clouds"][0]["stamp"]);
    last_s = seen["clouds"][0]["stamp"];
  }
  EXPECT_EQ(message["type"], "end");
  EXPECT_TRUE(message["success"]) << message;
}

TEST_F(Live, InterruptEndsARunningSession) {
  Served served(runner, "--speed 0.01");
  ASSERT_GT(served.port, 0);
  const auto stream = connect_live(served.port);
  receive(*stream);
  EXPECT_EQ(receive(*stream)["executed"], 0);
  EXPECT_EQ(served.stop(), 0);
}

TEST_F(Live, ForeignPagesMayNotListen) {
  Served served(runner, "");
  ASSERT_GT(served.port, 0);
  Stream stream(connect(context_, served.port));
  stream.set_option(beast::websocket::stream_base::decorator(
      [](auto& request) { request.set(beast::http::field::origin, "http://evil.example"); }));
  beast::error_code failed;
  stream.handshake("127.0.0.1:" + std::to_string(served.port), "/live", failed);
  EXPECT_EQ(failed, beast::websocket::error::upgrade_declined);
}

TEST_F(Live, NobodyElseOnTheNetworkCanConnect) {
  Served served(runner, "");
  ASSERT_GT(served.port, 0);
  ifaddrs* all = nullptr;
  ASSERT_EQ(::getifaddrs(&all), 0);
  int others = 0;
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    sockaddr_in address = *reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    if (ntohl(address.sin_addr.s_addr) >> 24 == 127) continue;
    ++others;
    address.sin_port = htons(static_cast<std::uint16_t>(served.port));
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    EXPECT_NE(::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    ::close(socket);
  }
  ::freeifaddrs(all);
  if (others == 0) GTEST_SKIP() << "this machine has no address but the loopback's";
}

TEST_F(ViewPlan, ServingRefusesAPortThatIsTakenAndAGraphThatDoesNotMove) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  ASSERT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(::listen(socket, 1), 0);
  ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
  const std::string port = std::to_string(ntohs(address.sin_port));
  expect_refusal(runner.run("view p.g2o --no-check --serve " + port), "", "port " + port);
  ::close(socket);
  runner.write("pose.g2o", "VERTEX_SE2 0 0 0 0\n");
  expect_refusal(runner.run("view pose.g2o --serve 0"), "pose.g2o", "nothing to run");
}

}  // namespace
}  // namespace locograph
