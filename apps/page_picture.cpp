#include <locograph/apps/child_process.h>
#include <locograph/apps/output.h>
#include <locograph/apps/page_picture.h>
#include <locograph/common/atomic_file.h>

namespace locograph {
namespace {

constexpr double kTimeout_s = 120.0;

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

}  // namespace

void require_browser() { browser(); }

void save_page_picture(const std::filesystem::path& page, double time_s,
                       const std::filesystem::path& png) {
  const ScratchFolder folder;
  const std::filesystem::path shot = folder.path() / "shot.png";
  // Without all compositor stages the picture may be taken before the first frame is shown.
  const ProcessResult result = run_process(
      browser(),
      {"--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
       "--disable-background-networking", "--disable-component-update", "--disable-sync",
       "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
       "--hide-scrollbars", "--user-data-dir=" + (folder.path() / "profile").string(),
       "--window-size=1280,720", "--virtual-time-budget=10000",
       "--run-all-compositor-stages-before-draw", "--screenshot=" + shot.string(),
       file_url(page) + "#t=" + short_number(time_s) + "&ui=0"},
      kTimeout_s);
  if (result.timed_out) throw Error("Chromium did not finish the picture", "one in two minutes");
  std::error_code failed;
  if (std::filesystem::file_size(shot, failed) == 0 || failed) {
    throw Error("Chromium made no picture: " + result.last_line(), "a PNG");
  }
  write_file_atomically(png, read_file(shot));
}

}  // namespace locograph
