#pragma once
/// A folder for `--clouds`, as a camera of CENTAURO would have left it.
///
///     write_clouds(runner, "0.0,D435i_camera,a.pcd");

#include <apps/command_runner.h>

#include <string>

namespace locograph {

/// In `clouds`, listed with this line: a cloud of a square metre, two metres ahead of the camera.
inline void write_clouds(const CommandRunner& runner, const std::string& line) {
  std::filesystem::create_directory(runner.folder() / "clouds");
  std::string points;
  for (int i = -20; i <= 20; ++i) {
    for (int k = -20; k <= 20; ++k) {
      points += std::to_string(0.025 * i) + ' ' + std::to_string(0.025 * k) + " 2\n";
    }
  }
  const std::string count = std::to_string(41 * 41);
  runner.write("clouds/a.pcd",
               "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + count +
                   "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA ascii\n" +
                   points);
  runner.write("clouds/clouds.csv", "time_s,camera,file\n" + line + '\n');
}

}  // namespace locograph
