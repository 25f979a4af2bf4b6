#pragma once
/// An edge's line in a file, behind its tag and vertices: size of the error where that is known at
/// run time only, fields, then Ω.
///
///     EdgeRange edge;
///     detail::read_edge_line(edge, 2, in);      // after the ids of its two vertices
///
/// Ω is the upper triangle row by row; weights are `scalar w` when all are equal, `scalar w without
/// k row…` when k of many rows have none and the others are equal (rows from 0, ascending),
/// `diagonal w…` otherwise; each from 0 to ranges::kWeight. Included by typed_edge_pool.h only.

#include <locograph/common/ranges.h>
#include <locograph/core/edge_evaluation.h>

#include <string>

namespace locograph::detail {

/// Whether the size of the error stands in the file.
template <class E>
inline constexpr bool kSizeInFile = E::kDynamicArity || E::kDimension == Eigen::Dynamic;

/// The size of the error, before anything is reserved for it: never much more than the line is
/// long, however absurd the number in the file.
template <class E>
int read_error_size([[maybe_unused]] int vertices, FieldReader& in) {
  int size = in.integer();
  if constexpr (requires { E::kRowsPerVertex; }) {
    const int many = vertices - fixed_slot_count<E>();
    if (size != many) {
      in.fail("measurements of " + std::to_string(size) + " vertices",
              "as many as the edge names, " + std::to_string(many));
    }
    size *= E::kRowsPerVertex;
  }
  if (size < 1 || (E::kDimension != Eigen::Dynamic && size != E::kDimension)) {
    in.fail("error of size " + std::to_string(size), E::kDimension == Eigen::Dynamic
                                                         ? "a positive size"
                                                         : "size " + std::to_string(E::kDimension));
  }
  // A digit and a blank for each number of Ω. Equal weights are written as one number: of them
  // nothing but a bound can be asked.
  constexpr int kMostRowsOfEqualWeight = 1 << 16;
  const double left = static_cast<double>(in.characters_left()) + 1.0;
  const bool too_many = kHasWeights<E> ? size > kMostRowsOfEqualWeight && size > left
                                       : 1.0 * size * (size + 1) > left;
  if (E::kDimension == Eigen::Dynamic && too_many) {
    in.fail("too few fields for an error of size " + std::to_string(size),
            kHasWeights<E> ? "its weights" : "its information matrix");
  }
  return size;
}

template <class E>
void read_weights(E& edge, int size, FieldReader& in) {
  const std::string kind = in.word();
  if (kind != "scalar" && kind != "diagonal") {
    in.fail("weights begin with '" + kind + "'", "'scalar' or 'diagonal'");
  }
  edge.weights.resize(size);
  for (int r = 0; r < size; ++r) {
    if (kind == "scalar" && r > 0) {
      edge.weights[r] = edge.weights[0];
      continue;
    }
    const std::string_view weight = in.peek();
    edge.weights[r] = in.number();
    if (edge.weights[r] < 0.0) in.fail("a negative weight", "weights >= 0");
    if (edge.weights[r] > ranges::kWeight)
      in.fail("the weight " + std::string(weight), "at most 1e30");
  }
  if (kind != "scalar" || in.peek() != "without") return;
  in.word();
  const int count = in.integer();
  if (count < 1) in.fail(std::to_string(count) + " rows without weight", "1 or more");
  for (int k = 0, last = -1; k < count; ++k) {
    const int row = in.integer();
    if (row <= last || row >= size) {
      in.fail("row " + std::to_string(row) + " without weight",
              "ascending rows, 0 to " + std::to_string(size - 1));
    }
    edge.weights[row] = 0.0;
    last = row;
  }
}

/// Writes `scalar w without …` where that is what the weights are and there are many; false: not.
template <class E>
bool write_weights_without(const E& edge, FieldWriter& out) {
  constexpr int kMany = 24;
  const double most = edge.weights.maxCoeff();
  const Eigen::Index none = (edge.weights.array() == 0.0).count();
  const Eigen::Index equal = (edge.weights.array() == most).count();
  if (edge.dimension() < kMany || !(most > 0.0) || none == 0 || none + equal != edge.dimension()) {
    return false;
  }
  out.word("scalar");
  out.number(most);
  out.word("without");
  out.integer(static_cast<long>(none));
  for (int r = 0; r < edge.dimension(); ++r) {
    if (edge.weights[r] == 0.0) out.integer(r);
  }
  return true;
}

template <class E>
void write_weights(const E& edge, FieldWriter& out) {
  if (write_weights_without(edge, out)) return;
  const bool scalar = (edge.weights.array() == edge.weights[0]).all();
  out.word(scalar ? "scalar" : "diagonal");
  for (int r = 0; r < (scalar ? 1 : edge.dimension()); ++r) out.number(edge.weights[r]);
}

template <class E>
void read_edge_line(E& edge, int vertices, FieldReader& in) {
  int size = E::kDimension;
  if constexpr (kSizeInFile<E>) size = read_error_size<E>(vertices, in);
  if constexpr (requires { edge.resize(size); }) edge.resize(size);
  read_fields(in, edge.fields());
  if constexpr (kHasWeights<E>) {
    read_weights(edge, size, in);
  } else {
    edge.information.resize(size, size);
    for (int r = 0; r < size; ++r) {
      for (int c = r; c < size; ++c) {
        edge.information(r, c) = in.number();
        edge.information(c, r) = edge.information(r, c);
      }
    }
  }
}

template <class E>
void write_edge_line(const E& edge, FieldWriter& out) {
  const int size = edge.dimension();
  if constexpr (requires { E::kRowsPerVertex; }) {
    out.integer(size / E::kRowsPerVertex);
  } else if constexpr (kSizeInFile<E>) {
    out.integer(size);
  }
  write_fields(out, const_cast<E&>(edge).fields());
  if constexpr (kHasWeights<E>) {
    write_weights(edge, out);
  } else {
    for (int r = 0; r < size; ++r) {
      for (int c = r; c < size; ++c) out.number(edge.information(r, c));
    }
  }
}

}  // namespace locograph::detail
