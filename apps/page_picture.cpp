#include <locograph/apps/child_process.h>
#include <locograph/apps/output.h>
#include <locograph/apps/page_picture.h>
#include <locograph/common/atomic_file.h>
#include <locograph/common/input_file.h>

#include <cctype>
#include <string>

namespace locograph {
namespace {

constexpr double kBrowserTimeout_s = 120.0;
/// A picture of one colour, 1280 × 720, has about 4 kB; one with a ground grid has 100.
constexpr std::size_t kBlankBytes = 8000;

std::filesystem::path browser() {
  const auto found =
      find_program({"chromium", "chromium-browser", "google-chrome", "google-chrome-stable"});
  if (!found) {
    throw Error("no Chromium on the PATH to take a picture with",
                "the Debian package chromium, or the page without --png");
  }
  return *found;
}

/// RFC 3986: everything but letters, digits and a few marks as %XX.
std::string file_url(const std::filesystem::path& file) {
  constexpr char kHex[] = "0123456789ABCDEF";
  std::string url = "file://";
  for (const unsigned char c : std::filesystem::absolute(file).string()) {
    if (std::isalnum(c) || c == '/' || c == '-' || c == '_' || c == '.') {
      url += static_cast<char>(c);
    } else {
      url += {'%', kHex[c >> 4], kHex[c & 15]};
    }
  }
  return url;
}

/// The bytes of a PNG taken patience_ms after the start.
std::string shoot(const std::filesystem::path& chromium, const std::string& url, int patience_ms) {
  const ScratchFolder folder;
  const std::filesystem::path shot = folder.path() / "shot.png";
  const ProcessResult result = run_process(
      chromium,
      {"--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
       "--disable-background-networking", "--disable-component-update", "--disable-sync",
       "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
       "--hide-scrollbars", "--user-data-dir=" + (folder.path() / "profile").string(),
       "--window-size=1280,720", "--timeout=" + std::to_string(patience_ms),
       "--screenshot=" + shot.string(), url},
      kBrowserTimeout_s);
  if (result.timed_out) throw Error("Chromium did not finish the picture", "one in two minutes");
  if (!std::filesystem::is_regular_file(shot)) {
    throw Error("Chromium made no picture: " + result.last_line(), "a PNG");
  }
  return read_file(shot);
}

}  // namespace

void require_browser() { browser(); }

void save_page_picture(const std::filesystem::path& page, double time_s,
                       const std::filesystem::path& png) {
  const std::filesystem::path chromium = browser();
  const std::string url = file_url(page) + "#t=" + short_number(time_s) + "&ui=0";
  // Real time, not Chromium's virtual time, which now and then ends before the first frame is
  // shown. A machine that is too busy for the first patience gets more.
  for (const int patience_ms : {5000, 15000, 45000}) {
    const std::string picture = shoot(chromium, url, patience_ms);
    if (picture.size() < kBlankBytes) continue;
    write_file_atomically(png, picture);
    return;
  }
  throw Error("Chromium shows nothing of the page", "a machine on which WebGL works");
}

}  // namespace locograph
