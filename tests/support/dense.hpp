#pragma once

#include "treacle/core/vec.hpp"
#include "treacle/linear/block_csr.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace treacle::test {

using Index = std::ptrdiff_t;

class DiagonalMatrix;

/// A vector of doubles for oracles, which starts with zeros. Its algebra and that of Matrix is Eigen's, under
/// Eigen's names, but behind ordinary functions: Eigen's templates take seconds to compile wherever they are used.
class Vector {
 public:
  using value_type = double;
  using iterator = double*;
  using const_iterator = const double*;

  Vector() = default;
  explicit Vector(Index size);
  explicit Vector(std::span<const double> values);
  explicit Vector(std::span<const float> values);

  static Vector Zero(Index size);
  static Vector Ones(Index size);
  static Vector Constant(Index size, double value);
  static Vector Unit(Index size, Index place);

  Index size() const { return static_cast<Index>(numbers_.size()); }
  double* data() { return numbers_.data(); }
  const double* data() const { return numbers_.data(); }
  double* begin() { return data(); }
  double* end() { return data() + size(); }
  const double* begin() const { return data(); }
  const double* end() const { return data() + size(); }
  double& operator[](Index i) { return numbers_[static_cast<std::size_t>(i)]; }
  const double& operator[](Index i) const { return numbers_[static_cast<std::size_t>(i)]; }

  Vector& operator+=(const Vector& other);
  Vector& operator-=(const Vector& other);
  Vector& operator*=(double factor);
  Vector& operator/=(double divisor);
  void setZero();
  void setHead(const Vector& values);  // the first ones
  void setTail(const Vector& values);  // the last ones

  double norm() const;
  double squaredNorm() const;
  double dot(const Vector& other) const;
  double sum() const;
  double maxCoeff() const;
  double minCoeff() const;

  Vector head(Index count) const;
  Vector cwiseProduct(const Vector& other) const;
  Vector cwiseAbs() const;
  Vector cwiseSqrt() const;
  Vector cwiseInverse() const;
  Vector cwiseInverseOrZero() const;  // zero for zeros
  DiagonalMatrix asDiagonal() const;

  bool operator==(const Vector&) const = default;

 private:
  std::vector<double> numbers_;
};

Vector operator+(Vector a, const Vector& b);
Vector operator-(Vector a, const Vector& b);
Vector operator-(Vector a);
Vector operator*(double factor, Vector a);
Vector operator*(Vector a, double factor);
Vector operator/(Vector a, double divisor);

/// A dense matrix, stored by columns, which starts with zeros.
class Matrix {
 public:
  Matrix() = default;
  Matrix(Index rows, Index columns);
  Matrix(const DiagonalMatrix& diagonal);

  static Matrix Zero(Index rows, Index columns);
  static Matrix Constant(Index rows, Index columns, double value);
  static Matrix Identity(Index rows, Index columns);
  static Matrix Random(Index rows, Index columns);  // between -1 and 1

  Index rows() const { return rows_; }
  Index cols() const { return columns_; }
  double* data() { return numbers_.data(); }
  const double* data() const { return numbers_.data(); }
  double& operator()(Index i, Index j) { return numbers_[static_cast<std::size_t>(i + rows_ * j)]; }
  const double& operator()(Index i, Index j) const { return numbers_[static_cast<std::size_t>(i + rows_ * j)]; }

  Matrix& operator+=(const Matrix& other);
  Matrix& operator-=(const Matrix& other);
  Matrix& operator*=(double factor);
  void setRow(Index i, const Vector& values);
  void setCol(Index j, const Vector& values);
  void addToDiagonal(const Vector& values);

  double norm() const;  // Frobenius'
  Vector diagonal() const;
  Vector row(Index i) const;
  Vector col(Index j) const;
  Vector rowSums() const;
  Matrix leftCols(Index count) const;
  Matrix rightCols(Index count) const;
  Matrix block(Index i, Index j, Index rows, Index columns) const;
  Matrix transpose() const;
  Matrix cwiseAbs() const;

  bool operator==(const Matrix&) const = default;

 private:
  Index rows_ = 0, columns_ = 0;
  std::vector<double> numbers_;
};

Matrix operator+(Matrix a, const Matrix& b);
Matrix operator-(Matrix a, const Matrix& b);
Matrix operator-(Matrix a);
Matrix operator*(double factor, Matrix a);
Matrix operator*(Matrix a, double factor);
Matrix operator/(Matrix a, double divisor);
Matrix operator*(const Matrix& a, const Matrix& b);
Vector operator*(const Matrix& a, const Vector& x);

class DiagonalMatrix {
 public:
  explicit DiagonalMatrix(Vector diagonal);
  const Vector& diagonal() const { return diagonal_; }

 private:
  Vector diagonal_;
};
Matrix operator*(const DiagonalMatrix& d, const Matrix& a);
Matrix operator*(const Matrix& a, const DiagonalMatrix& d);

/// b x
template <int D>
Vec<D> times(const Matrix& b, const Vec<D>& x) {
  Vec<D> product{};
  for (int r = 0; r < D; ++r)
    for (int c = 0; c < D; ++c) product[r] += b(r, c) * x[c];
  return product;
}

// Of symmetric matrices, which must be positive definite but for `eigenvalues`.

/// x of A x = b.
Vector solve(const Matrix& a, const Vector& b);
Matrix inverse(const Matrix& a);
/// In ascending order.
Vector eigenvalues(const Matrix& a);
/// The same with their eigenvectors, which are the columns of `vectors`.
struct EigenSystem {
  Vector values;
  Matrix vectors;
};
EigenSystem eigenSystem(const Matrix& a);
/// lambda of A x = lambda B x, where A need not be positive definite, in ascending order.
Vector generalisedEigenvalues(const Matrix& a, const Matrix& b);
/// Of M A, which need not be symmetric itself, in ascending order.
Vector eigenvaluesOfProduct(const Matrix& m, const Matrix& a);

Vector randomVector(Index size, unsigned seed);  // normally distributed

/// For B from 1 to 3.
template <int B>
Matrix dense(const BlockCsr<B>& a);

/// Dense matrix of a linear map by its action on the unit vectors.
template <class F>
Matrix denseOf(Index n, F&& map) {
  Matrix m(n, n);
  for (Index j = 0; j < n; ++j) m.setCol(j, map(Vector::Unit(n, j)));
  return m;
}

}  // namespace treacle::test
