#include "support/dense_eigen.hpp"

namespace treacle::test {

Vector solve(const Matrix& a, const Vector& b) { return vector(eigen(a).llt().solve(eigen(b))); }
Matrix inverse(const Matrix& a) {
  return matrix(eigen(a).llt().solve(Eigen::MatrixXd::Identity(a.rows(), a.rows())));
}
Vector eigenvalues(const Matrix& a) {
  return vector(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(eigen(a), Eigen::EigenvaluesOnly).eigenvalues());
}
EigenSystem eigenSystem(const Matrix& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(eigen(a));
  return {vector(solver.eigenvalues()), matrix(solver.eigenvectors())};
}
Vector generalisedEigenvalues(const Matrix& a, const Matrix& b) {
  // L^-1 A L^-T with B = L L^T.
  const Eigen::LLT<Eigen::MatrixXd> factors(eigen(b));
  const Eigen::MatrixXd half = factors.matrixL().solve(eigen(a)), turned = half.transpose();
  return eigenvalues(matrix(factors.matrixL().solve(turned)));
}
Vector eigenvaluesOfProduct(const Matrix& m, const Matrix& a) {
  const Matrix l = matrix(eigen(a).llt().matrixL());
  return eigenvalues(l.transpose() * m * l);
}

}  // namespace treacle::test
