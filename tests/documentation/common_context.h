#pragma once
/// What the examples of common/ take for granted.

#include <Eigen/Dense>
#include <string>
#include <vector>

namespace locograph::documentation::in_common {

extern const std::string text;
extern const Eigen::Vector3d v, w;
extern const int chunks;
extern std::vector<double> sums;
double sum(int chunk);
void try_another_start();

}  // namespace locograph::documentation::in_common
