#pragma once
/// Where polynomials up to the third degree are zero within [0, 1].
///
///     UnitRoots roots = roots_in_unit({c0, c1, c2, c3});   // c0 + c1 s + c2 s^2 + c3 s^3
///     for (const double s : roots) look_at(s);
///
/// Between the zeros of its derivative a polynomial rises or falls, so that bisection finds each
/// zero with a change of sign to the last bit. Zeros without one (a touching parabola) are zeros of
/// the derivative too, which whoever looks for extrema of an integral does not need.

#include <array>
#include <cmath>

namespace locograph {

struct UnitRoots {
  std::array<double, 3> values{};
  int count = 0;
  const double* begin() const { return values.data(); }
  const double* end() const { return values.data() + count; }
};

inline UnitRoots roots_in_unit(const std::array<double, 4>& c) {
  const auto value = [&c](double s) { return c[0] + s * (c[1] + s * (c[2] + s * c[3])); };
  UnitRoots turns;
  if (c[2] != 0.0 || c[3] != 0.0) turns = roots_in_unit({c[1], 2.0 * c[2], 3.0 * c[3], 0.0});
  UnitRoots roots;
  double from = 0.0;
  for (int piece = 0; piece <= turns.count; ++piece) {
    const double end = piece < turns.count ? turns.values[static_cast<std::size_t>(piece)] : 1.0;
    double low = from, high = end;
    const double at_low = value(low);
    if ((at_low < 0.0) != (value(high) < 0.0) && roots.count < 3) {
      for (;;) {
        const double middle = 0.5 * (low + high);
        if (!(middle > low && middle < high)) break;
        ((value(middle) < 0.0) == (at_low < 0.0) ? low : high) = middle;
      }
      roots.values[static_cast<std::size_t>(roots.count++)] = low;
    }
    from = end;
  }
  return roots;
}

}  // namespace locograph
