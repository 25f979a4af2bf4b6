#pragma once
/// PCD files as text.
///
///     folder.write("a.pcd", pcd_text(2, 1, "0 0 1\nnan nan nan\n"));

#include <string>

namespace locograph::test {

/// points: a line for each of width * height.
inline std::string pcd_text(int width, int height, const std::string& points,
                            const std::string& viewpoint = "0 0 0 1 0 0 0") {
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH " + std::to_string(width) +
         "\nHEIGHT " + std::to_string(height) + "\nVIEWPOINT " + viewpoint + "\nDATA ascii\n" +
         points;
}

}  // namespace locograph::test
