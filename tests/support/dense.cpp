#include "support/dense_eigen.hpp"

#include <random>

namespace treacle::test {

Vector::Vector(Index size) : numbers_(static_cast<std::size_t>(size)) {}
Vector::Vector(std::span<const double> values) : numbers_(values.begin(), values.end()) {}
Vector::Vector(std::span<const float> values) : numbers_(values.begin(), values.end()) {}

Vector Vector::Zero(Index size) { return Vector(size); }
Vector Vector::Ones(Index size) { return Constant(size, 1); }
Vector Vector::Constant(Index size, double value) {
  Vector v(size);
  eigen(v).setConstant(value);
  return v;
}
Vector Vector::Unit(Index size, Index place) {
  Vector v(size);
  v[place] = 1;
  return v;
}

Vector& Vector::operator+=(const Vector& other) {
  eigen(*this) += eigen(other);
  return *this;
}
Vector& Vector::operator-=(const Vector& other) {
  eigen(*this) -= eigen(other);
  return *this;
}
Vector& Vector::operator*=(double factor) {
  eigen(*this) *= factor;
  return *this;
}
Vector& Vector::operator/=(double divisor) {
  eigen(*this) /= divisor;
  return *this;
}
void Vector::setZero() { eigen(*this).setZero(); }
void Vector::setHead(const Vector& values) { eigen(*this).head(values.size()) = eigen(values); }
void Vector::setTail(const Vector& values) { eigen(*this).tail(values.size()) = eigen(values); }

double Vector::norm() const { return eigen(*this).norm(); }
double Vector::squaredNorm() const { return eigen(*this).squaredNorm(); }
double Vector::dot(const Vector& other) const { return eigen(*this).dot(eigen(other)); }
double Vector::sum() const { return eigen(*this).sum(); }
double Vector::maxCoeff() const { return eigen(*this).maxCoeff(); }
double Vector::minCoeff() const { return eigen(*this).minCoeff(); }

Vector Vector::head(Index count) const { return vector(eigen(*this).head(count)); }
Vector Vector::cwiseProduct(const Vector& other) const { return vector(eigen(*this).cwiseProduct(eigen(other))); }
Vector Vector::cwiseAbs() const { return vector(eigen(*this).cwiseAbs()); }
Vector Vector::cwiseSqrt() const { return vector(eigen(*this).cwiseSqrt()); }
Vector Vector::cwiseInverse() const { return vector(eigen(*this).cwiseInverse()); }
Vector Vector::cwiseInverseOrZero() const {
  Vector v = *this;
  for (double& x : v) x = x == 0 ? 0 : 1 / x;
  return v;
}
DiagonalMatrix Vector::asDiagonal() const { return DiagonalMatrix(*this); }

Vector operator+(Vector a, const Vector& b) { return a += b; }
Vector operator-(Vector a, const Vector& b) { return a -= b; }
Vector operator-(Vector a) { return a *= -1; }
Vector operator*(double factor, Vector a) { return a *= factor; }
Vector operator*(Vector a, double factor) { return a *= factor; }
Vector operator/(Vector a, double divisor) { return a /= divisor; }

Matrix::Matrix(Index rows, Index columns)
    : rows_(rows), columns_(columns), numbers_(static_cast<std::size_t>(rows * columns)) {}
Matrix::Matrix(const DiagonalMatrix& diagonal) : Matrix(diagonal.diagonal().size(), diagonal.diagonal().size()) {
  addToDiagonal(diagonal.diagonal());
}

Matrix Matrix::Zero(Index rows, Index columns) { return {rows, columns}; }
Matrix Matrix::Constant(Index rows, Index columns, double value) {
  Matrix m(rows, columns);
  eigen(m).setConstant(value);
  return m;
}
Matrix Matrix::Identity(Index rows, Index columns) {
  Matrix m(rows, columns);
  eigen(m).setIdentity();
  return m;
}
Matrix Matrix::Random(Index rows, Index columns) { return matrix(Eigen::MatrixXd::Random(rows, columns)); }

Matrix& Matrix::operator+=(const Matrix& other) {
  eigen(*this) += eigen(other);
  return *this;
}
Matrix& Matrix::operator-=(const Matrix& other) {
  eigen(*this) -= eigen(other);
  return *this;
}
Matrix& Matrix::operator*=(double factor) {
  eigen(*this) *= factor;
  return *this;
}
void Matrix::setRow(Index i, const Vector& values) { eigen(*this).row(i) = eigen(values); }
void Matrix::setCol(Index j, const Vector& values) { eigen(*this).col(j) = eigen(values); }
void Matrix::addToDiagonal(const Vector& values) { eigen(*this).diagonal() += eigen(values); }

double Matrix::norm() const { return eigen(*this).norm(); }
Vector Matrix::diagonal() const { return vector(eigen(*this).diagonal()); }
Vector Matrix::row(Index i) const { return vector(eigen(*this).row(i)); }
Vector Matrix::col(Index j) const { return vector(eigen(*this).col(j)); }
Vector Matrix::rowSums() const { return vector(eigen(*this).rowwise().sum()); }
Matrix Matrix::leftCols(Index count) const { return matrix(eigen(*this).leftCols(count)); }
Matrix Matrix::rightCols(Index count) const { return matrix(eigen(*this).rightCols(count)); }
Matrix Matrix::block(Index i, Index j, Index rows, Index columns) const {
  return matrix(eigen(*this).block(i, j, rows, columns));
}
Matrix Matrix::transpose() const { return matrix(eigen(*this).transpose()); }
Matrix Matrix::cwiseAbs() const { return matrix(eigen(*this).cwiseAbs()); }

Matrix operator+(Matrix a, const Matrix& b) { return a += b; }
Matrix operator-(Matrix a, const Matrix& b) { return a -= b; }
Matrix operator-(Matrix a) { return a *= -1; }
Matrix operator*(double factor, Matrix a) { return a *= factor; }
Matrix operator*(Matrix a, double factor) { return a *= factor; }
Matrix operator/(Matrix a, double divisor) { return a *= 1 / divisor; }
Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix product(a.rows(), b.cols());
  eigen(product).noalias() = eigen(a) * eigen(b);
  return product;
}
Vector operator*(const Matrix& a, const Vector& x) {
  Vector product(a.rows());
  eigen(product).noalias() = eigen(a) * eigen(x);
  return product;
}

DiagonalMatrix::DiagonalMatrix(Vector diagonal) : diagonal_(std::move(diagonal)) {}
Matrix operator*(const DiagonalMatrix& d, const Matrix& a) {
  return matrix(eigen(d.diagonal()).asDiagonal() * eigen(a));
}
Matrix operator*(const Matrix& a, const DiagonalMatrix& d) {
  return matrix(eigen(a) * eigen(d.diagonal()).asDiagonal());
}

Vector randomVector(Index size, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Vector v(size);
  for (double& x : v) x = normal(random);
  return v;
}

template <int B>
Matrix dense(const BlockCsr<B>& a) {
  Matrix m(B * a.rows(), B * a.rows());
  for (std::uint32_t i = 0; i < a.rows(); ++i)
    for (std::uint64_t k = a.rowStart[i]; k < a.rowStart[i + 1]; ++k)
      for (int r = 0; r < B; ++r)
        for (int c = 0; c < B; ++c) m(B * i + r, B * a.column[k] + c) += a.value[k](r, c);
  return m;
}
template Matrix dense(const BlockCsr<1>&);
template Matrix dense(const BlockCsr<2>&);
template Matrix dense(const BlockCsr<3>&);

}  // namespace treacle::test
