#pragma once
/// Depth images as a camera like the D435i would take them of a world that is known.
///
///     SimulatedCamera cameras(robot, world);
///     DepthImage image = cameras.take(camera, 0, state, time_s, seed);
///
///     SimulatedCamera without_noise(robot, world, CameraNoise::none());
///     std::vector<std::int16_t> shows;
///     DepthImage truth = without_noise.take(camera, 0, state, time_s, seed, &shows);
///     if (shows[0] == camera.link) report(cameras.shown(shows[0]).name, "sees itself");
///
/// Cast by exact shapes (ray_caster.h), made noisy (camera_noise.h). The same bits for the same
/// arguments, whatever the number of threads; each camera and each time has noise of its own.
/// Not modelled: exposure, motion while it is taken (all pixels are of one time), errors of depth
/// that neighbouring pixels share, glass and mirrors, the sun. Thread-safety: one per thread.

#include <locograph/world/perception/camera_noise.h>
#include <locograph/world/perception/ray_caster.h>

namespace locograph {

class SimulatedCamera {
 public:
  /// Throws Error for noise that cannot be used, and as RayCaster does.
  SimulatedCamera(const Robot& robot, const World& truth, const CameraNoise& noise = {},
                  int threads = 1);

  /// camera: its index in the list of cameras, for the image. state: of the robot then. shows: if
  /// given, what each pixel meets first within the range, also where noise lost it or mixed it with
  /// what is beside it, and nearer than the range begins (FirstHits::shows).
  DepthImage take(const DepthCamera& optics, int camera, const RobotState& state, double time_s,
                  std::uint64_t seed, std::vector<std::int16_t>* shows = nullptr);

  Shown shown(int number) const { return rays_.shown(number); }

 private:
  RayCaster rays_;
  CameraNoise noise_;
  FirstHits hits_;
};

}  // namespace locograph
