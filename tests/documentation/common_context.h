#pragma once
/// What the examples of common/ take for granted.

#include <locograph/common/error.h>

#include <Eigen/Dense>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

namespace locograph::documentation::in_common {

extern const std::string text, name, file;
extern const int line;
extern const double x;
extern const std::vector<std::string> known;
extern const Eigen::Vector3d v, w;
extern const int chunks;
extern std::vector<double> sums;
double sum(int chunk);
void try_another_start();

}  // namespace locograph::documentation::in_common
