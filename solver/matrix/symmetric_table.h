#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <tbb/parallel_for.h>

namespace reemit {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// One number per unordered pair of different indices; the diagonal is 0. Rows hold the partners above the
/// diagonal, so that row i is contiguous in memory: (i,i+1) .. (i,n-1).
template <class T>
class SymmetricTable {
 public:
  explicit SymmetricTable(std::size_t size = 0)
      : size_(size), values_(size < 2 ? 0 : size * (size - 1) / 2) {}

  std::size_t size() const { return size_; }
  T at(std::size_t i, std::size_t j) const {
    if (i == j) return T{};
    if (i > j) std::swap(i, j);
    return values_[first_of(i) + (j - i - 1)];
  }
  /// Pre: i and j differ.
  void add(std::size_t i, std::size_t j, T value) {
    if (i > j) std::swap(i, j);
    values_[first_of(i) + (j - i - 1)] += value;
  }
  /// Pairs of i with i+1 .. size-1.
  T* row(std::size_t i) { return values_.data() + first_of(i); }
  const T* row(std::size_t i) const { return values_.data() + first_of(i); }
  std::size_t row_length(std::size_t i) const { return size_ - i - 1; }

  /// Matrix times vector. The sum of each element has a fixed order: the same bits on any number of threads.
  Eigen::VectorXd times(const Eigen::VectorXd& x) const;
  /// The same for many vectors at once, one per column.
  RowMatrix times_columns(const RowMatrix& x) const;
  /// Sums of rows of the symmetric table that has value(i, k) at the places (i, i + 1 + k) and (i + 1 + k,
  /// i).
  template <class Value>
  Eigen::VectorXd row_sums(Value value) const;

 private:
  static constexpr std::size_t kParts = 16;

  std::size_t first_of(std::size_t i) const { return i * (2 * size_ - i - 1) / 2; }

  std::size_t size_;
  std::vector<T> values_;
};

template <class T>
Eigen::VectorXd SymmetricTable<T>::times(const Eigen::VectorXd& x) const {
  const auto n = static_cast<Eigen::Index>(size_);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(kParts));
  // Part p takes rows p, p + kParts, ...: all parts have about the same work.
  tbb::parallel_for(std::size_t{0}, kParts, [&](std::size_t part) {
    auto sum = sums.col(static_cast<Eigen::Index>(part));
    for (std::size_t i = part; i + 1 < size_; i += kParts) {
      const auto at = static_cast<Eigen::Index>(i);
      const auto length = static_cast<Eigen::Index>(row_length(i));
      const auto values = Eigen::Map<const Eigen::VectorX<T>>(row(i), length).template cast<double>();
      sum(at) += values.dot(x.segment(at + 1, length));
      sum.segment(at + 1, length) += x(at) * values;
    }
  });
  return sums.rowwise().sum();
}

template <class T>
template <class Value>
Eigen::VectorXd SymmetricTable<T>::row_sums(Value value) const {
  const auto n = static_cast<Eigen::Index>(size_);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(n, static_cast<Eigen::Index>(kParts));
  tbb::parallel_for(std::size_t{0}, kParts, [&](std::size_t part) {
    auto sum = sums.col(static_cast<Eigen::Index>(part));
    for (std::size_t i = part; i + 1 < size_; i += kParts)
      for (std::size_t k = 0; k < row_length(i); ++k) {
        const double of_pair = value(i, k);
        sum(static_cast<Eigen::Index>(i)) += of_pair;
        sum(static_cast<Eigen::Index>(i + 1 + k)) += of_pair;
      }
  });
  return sums.rowwise().sum();
}

template <class T>
RowMatrix SymmetricTable<T>::times_columns(const RowMatrix& x) const {
  const auto n = static_cast<Eigen::Index>(size_);
  std::array<RowMatrix, kParts> sums;
  tbb::parallel_for(std::size_t{0}, kParts, [&](std::size_t part) {
    RowMatrix& sum = sums[part];
    sum = RowMatrix::Zero(n, x.cols());
    for (std::size_t i = part; i + 1 < size_; i += kParts) {
      const auto at = static_cast<Eigen::Index>(i);
      const T* values = row(i);
      for (std::size_t k = 0; k < row_length(i); ++k) {
        if (values[k] == T{}) continue;
        const auto value = static_cast<double>(values[k]);
        const auto other = static_cast<Eigen::Index>(i + 1 + k);
        sum.row(at) += value * x.row(other);
        sum.row(other) += value * x.row(at);
      }
    }
  });
  for (std::size_t part = 1; part < kParts; ++part) sums[0] += sums[part];
  return std::move(sums[0]);
}

}  // namespace reemit
