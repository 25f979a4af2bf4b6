#pragma once
/// The 27 models of NIST StRD as edges, by number of parameters.

#include <locograph/core/edge.h>
#include <locograph/core/vertex.h>

#include <numbers>
#include <string_view>

#include "nist_problem.h"

namespace locograph {

template <int N>
struct VertexNist : Vertex<N, N> {
  template <class T>
  using View = Eigen::Matrix<T, N, 1>;
  template <class T>
  static View<T> view(const T* s) {
    return View<T>(Eigen::Map<const View<T>>(s));
  }
  template <class T>
  static void oplus(const T* s, const T* d, T* out) {
    for (int i = 0; i < N; ++i) out[i] = s[i] + d[i];
  }
};

enum class NistModel {
  kBennett5,
  kBoxBod,
  kChwirut,
  kDanWood,
  kEckerle4,
  kEnso,
  kGauss,
  kHahn1,
  kKirby2,
  kLanczos,
  kMgh09,
  kMgh10,
  kMgh17,
  kMisra1b,
  kMisra1c,
  kMisra1d,
  kNelson,
  kRat42,
  kRat43,
  kRoszman1,
};

/// What is regressed on: the response, or its logarithm.
inline double nist_response(NistModel model, double y) {
  return model == NistModel::kNelson ? std::log(y) : y;
}

/// b: the N parameters b1…, x: the predictors. Only models of N parameters are in it.
template <int N, class T>
T nist_prediction(NistModel model, const T* b, const std::array<double, 2>& predictors) {
  using std::atan2;
  using std::cos;
  using std::exp;
  using std::pow;
  using std::sin;
  const double x = predictors[0];
  if constexpr (N == 2) {
    switch (model) {
      case NistModel::kBoxBod:
        return b[0] * (1.0 - exp(-b[1] * x));
      case NistModel::kDanWood:
        return b[0] * pow(T(x), b[1]);
      case NistModel::kMisra1b:
        return b[0] * (1.0 - 1.0 / ((1.0 + b[1] * x / 2.0) * (1.0 + b[1] * x / 2.0)));
      case NistModel::kMisra1c:
        return b[0] * (1.0 - pow(1.0 + 2.0 * b[1] * x, -0.5));
      case NistModel::kMisra1d:
        return b[0] * b[1] * x / (1.0 + b[1] * x);
      default:
        break;
    }
  } else if constexpr (N == 3) {
    switch (model) {
      case NistModel::kBennett5:
        return b[0] * pow(b[1] + x, -1.0 / b[2]);
      case NistModel::kChwirut:
        return exp(-b[0] * x) / (b[1] + b[2] * x);
      case NistModel::kEckerle4:
        return b[0] / b[1] * exp(-0.5 * ((x - b[2]) / b[1]) * ((x - b[2]) / b[1]));
      case NistModel::kMgh10:
        return b[0] * exp(b[1] / (x + b[2]));
      case NistModel::kNelson:
        return b[0] - b[1] * x * exp(-b[2] * predictors[1]);
      case NistModel::kRat42:
        return b[0] / (1.0 + exp(b[1] - b[2] * x));
      default:
        break;
    }
  } else if constexpr (N == 4) {
    switch (model) {
      case NistModel::kMgh09:
        return b[0] * (x * x + x * b[1]) / (x * x + x * b[2] + b[3]);
      case NistModel::kRat43:
        return b[0] / pow(1.0 + exp(b[1] - b[2] * x), 1.0 / b[3]);
      case NistModel::kRoszman1:
        // The data set's b1 is that of the angle in (0, π), one more than with the principal value.
        return b[0] - b[1] * x - atan2(b[2], x - b[3]) / std::numbers::pi;
      default:
        break;
    }
  } else if constexpr (N == 5) {
    if (model == NistModel::kKirby2) {
      return (b[0] + x * (b[1] + x * b[2])) / (1.0 + x * (b[3] + x * b[4]));
    }
    return b[0] + b[1] * exp(-x * b[3]) + b[2] * exp(-x * b[4]);  // MGH17
  } else if constexpr (N == 6) {
    return b[0] * exp(-b[1] * x) + b[2] * exp(-b[3] * x) + b[4] * exp(-b[5] * x);  // Lanczos
  } else if constexpr (N == 7) {
    return (b[0] + x * (b[1] + x * (b[2] + x * b[3]))) /
           (1.0 + x * (b[4] + x * (b[5] + x * b[6])));  // Hahn1, Thurber
  } else if constexpr (N == 8) {
    const T first = (x - b[3]) / b[4], second = (x - b[6]) / b[7];
    return b[0] * exp(-b[1] * x) + b[2] * exp(-first * first) + b[5] * exp(-second * second);
  } else {
    static_assert(N == 9);
    const double turn = 2.0 * std::numbers::pi * x;
    return b[0] + b[1] * std::cos(turn / 12.0) + b[2] * std::sin(turn / 12.0) +
           b[4] * cos(turn / b[3]) + b[5] * sin(turn / b[3]) + b[7] * cos(turn / b[6]) +
           b[8] * sin(turn / b[6]);
  }
  return T(0.0);
}

/// One observation. Error (1): prediction − response.
template <int N>
struct EdgeNist : Edge<1, VertexNist<N>> {
  NistModel model = NistModel::kBoxBod;
  std::array<double, 2> predictors{};
  double response = 0.0;

  template <class T>
  void error(const Eigen::Matrix<T, N, 1>& b, Eigen::Ref<Eigen::Matrix<T, 1, 1>> e) const {
    e[0] = nist_prediction<N>(model, b.data(), predictors) - response;
  }
};

/// Graphs of these are never written: the tags only tell the types apart.
template <int N>
constexpr std::string_view locograph_tag(const VertexNist<N>*) {
  return "VERTEX_NIST";
}
template <int N>
constexpr std::string_view locograph_tag(const EdgeNist<N>*) {
  return "EDGE_NIST";
}

/// The model of a data set. Throws Error for an unknown name.
NistModel nist_model(const std::string& name);

/// Calls f(std::integral_constant<int, N>) for N parameters.
template <class F>
void with_parameter_count(int n, F&& f) {
  switch (n) {
    case 2:
      return f(std::integral_constant<int, 2>());
    case 3:
      return f(std::integral_constant<int, 3>());
    case 4:
      return f(std::integral_constant<int, 4>());
    case 5:
      return f(std::integral_constant<int, 5>());
    case 6:
      return f(std::integral_constant<int, 6>());
    case 7:
      return f(std::integral_constant<int, 7>());
    case 8:
      return f(std::integral_constant<int, 8>());
    case 9:
      return f(std::integral_constant<int, 9>());
    default:
      throw Error(std::to_string(n) + " parameters", "2 to 9");
  }
}

}  // namespace locograph
