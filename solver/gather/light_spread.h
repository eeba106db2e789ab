#pragma once

namespace reemit {

/// Light over an area from points that were looked at twice, with noise that is independent.
class LightSpread {
 public:
  /// A point by its two looks, in any unit.
  void add(double first_look, double second_look) {
    first_ += first_look;
    second_ += second_look;
    product_ += first_look * second_look;
    ++points_;
  }

  double mean() const { return 0.5 * (first_ + second_) / points_; }
  /// Over the area: the covariance of the looks, in which their noise cancels; an estimate, which may be
  /// below 0.
  double variance() const { return (product_ - first_ * second_ / points_) / (points_ - 1); }

 private:
  double first_ = 0;
  double second_ = 0;
  double product_ = 0;
  double points_ = 0;
};

}  // namespace reemit
