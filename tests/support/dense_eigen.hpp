#pragma once

#include "support/dense.hpp"

#include <Eigen/Dense>

namespace treacle::test {

// Eigen's view of vectors and matrices, and its results as such; for the sources of dense.hpp alone.

inline auto eigen(Vector& v) { return Eigen::Map<Eigen::VectorXd>(v.data(), v.size()); }
inline auto eigen(const Vector& v) { return Eigen::Map<const Eigen::VectorXd>(v.data(), v.size()); }
inline auto eigen(Matrix& m) { return Eigen::Map<Eigen::MatrixXd>(m.data(), m.rows(), m.cols()); }
inline auto eigen(const Matrix& m) { return Eigen::Map<const Eigen::MatrixXd>(m.data(), m.rows(), m.cols()); }

inline Vector vector(const Eigen::VectorXd& values) {
  Vector v(values.size());
  eigen(v) = values;
  return v;
}
inline Matrix matrix(const Eigen::MatrixXd& values) {
  Matrix m(values.rows(), values.cols());
  eigen(m) = values;
  return m;
}

}  // namespace treacle::test
