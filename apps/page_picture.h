#pragma once
/// A picture of a page without anyone at the screen: headless Chromium, if there is one.
///
///     save_page_picture("plan.html", 12.5, "frame.png");

#include <filesystem>

namespace locograph {

/// Throws Error when there is no Chromium, with the name of the Debian package.
void require_browser();

/// The page at time_s, 1280 × 720, without its controls. Written whole or not at all. Throws Error
/// when there is no Chromium or it fails.
void save_page_picture(const std::filesystem::path& page, double time_s,
                       const std::filesystem::path& png);

}  // namespace locograph
