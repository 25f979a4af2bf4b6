#pragma once
/// What a stereo depth camera makes of the depths in front of it.
///
///     CameraNoise noise;                // of a D435i
///     noise.per_m2 = 0.005;             // of poorly lit walls
///     add_noise(noise, camera, seed, depth_m, image);
///     add_noise(CameraNoise::none(), camera, 0, depth_m, truth);   // rounded to millimetres only
///
/// In this order, each pixel by itself:
///   shadow     the second imager, baseline_m to the right, does not see it: something nearer hides
///              it there, or the image ends (a band on the left of near things, and of the image)
///   lost       of all pixels, and of all squares of 8 x 8 pixels
///   edge       beside a pixel with another depth: lost, or flying, with a depth in between (drawn
///              evenly between the inverse depths)
///   error      a standard deviation of at_zero_m + per_m2 * depth^2: a disparity that is wrong by
///              as much at all depths. The sum of four even numbers: never more than 3.5 deviations
///   range      what is nearer or farther than the camera's range is lost
///
/// A pixel that is lost has depth 0. Random numbers come from a counter: the pixel and the seed
/// decide, whoever asks first.

#include <locograph/world/perception/depth_camera.h>
#include <locograph/world/perception/depth_image.h>

#include <cstdint>
#include <span>

namespace locograph {

struct CameraNoise {
  double at_zero_m = 0.0005;    ///< of the standard deviation
  double per_m2 = 0.003;        ///< of the standard deviation, times the square of the depth [m]
  double lost = 0.005;          ///< share of all pixels
  double lost_squares = 0.002;  ///< share of all squares of 8 x 8 pixels
  double edge = 0.05;           ///< depths further apart than this share make an edge
  double flying_at_edge = 0.5;  ///< share of the pixels at an edge
  double lost_at_edge = 0.2;    ///< share of the pixels at an edge
  double baseline_m = 0.05;     ///< 0: without shadows

  static CameraNoise none();
  void validate() const;
};

/// depth_m: for each pixel what it meets, infinite: nothing. Sets the image's size and depths.
void add_noise(const CameraNoise& noise, const DepthCamera& camera, std::uint64_t seed,
               std::span<const float> depth_m, DepthImage& image);

/// Of the image that a camera takes at a time, so that no two of a run have the same noise.
std::uint64_t noise_seed(std::uint64_t seed, int camera, double time_s);

}  // namespace locograph
