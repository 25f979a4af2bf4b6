#include <locograph/world/perception/simulated_camera.h>

namespace locograph {

SimulatedCamera::SimulatedCamera(const Robot& robot, const World& truth, const CameraNoise& noise,
                                 int threads)
    : rays_(robot, truth, threads), noise_(noise) {
  noise.validate();
}

DepthImage SimulatedCamera::take(const DepthCamera& optics, int camera, const RobotState& state,
                                 double time_s, std::uint64_t seed,
                                 std::vector<std::int16_t>* shows) {
  rays_.cast(optics, state, time_s, hits_);
  DepthImage image;
  image.stamp_s = time_s;
  image.camera = camera;
  add_noise(noise_, optics, noise_seed(seed, camera, time_s), hits_.depth_m, image);
  if (shows != nullptr) *shows = hits_.shows;
  return image;
}

}  // namespace locograph
