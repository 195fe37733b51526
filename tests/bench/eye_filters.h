// Filters that the shipped one is compared with: each as published or in common use, with the parameters that gave the best results here.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "base/deterministic_math.h"
#include "drivers/eye_tracker/filter.h"

namespace prismesh::drivers::eye_tracker::bench {

class Contender {
 public:
  virtual ~Contender() = default;
  virtual void take(const HeadSample& sample) = 0;
  virtual Eigen::Vector3d ahead(double seconds) const = 0;
};

/// The filter that the station uses.
class Shipped final : public Contender {
 public:
  void take(const HeadSample& sample) override { filter_.take(sample); }
  Eigen::Vector3d ahead(double seconds) const override {
    return predict(filter_.state(), filter_.state().time_ns + static_cast<std::int64_t>(seconds * 1e9));
  }

 private:
  HeadFilter filter_{HeadFilter::Options{}};
};

/// What the simpler ones share: time since the last sample, a place, a velocity, an acceleration.
class Moments : public Contender {
 public:
  void take(const HeadSample& sample) final {
    if (last_ns_ == 0) {
      place_ = sample.between_eyes_mm;
    } else {
      update(static_cast<double>(sample.measured_ns - last_ns_) * 1e-9, sample.between_eyes_mm);
    }
    last_ns_ = sample.measured_ns;
  }
  Eigen::Vector3d ahead(double seconds) const override { return place_ + velocity_ * seconds + acceleration_ * (0.5 * seconds * seconds); }

 protected:
  virtual void update(double seconds, const Eigen::Vector3d& measured) = 0;
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_ = Eigen::Vector3d::Zero();

 private:
  std::int64_t last_ns_ = 0;
};

class Raw final : public Moments {
  void update(double, const Eigen::Vector3d& measured) override { place_ = measured; }
};

/// Low-pass whose cutoff rises with speed (Casiez, Roussel and Vogel 2012), with or without going on by the velocity it finds.
class OneEuro final : public Moments {
 public:
  OneEuro(double cutoff_hz, double beta, bool goes_on) : cutoff_hz_(cutoff_hz), beta_(beta), goes_on_(goes_on) {}
  Eigen::Vector3d ahead(double seconds) const override { return goes_on_ ? Moments::ahead(seconds) : place_; }

 private:
  static double share(double cutoff_hz, double seconds) { return 1 / (1 + 1 / (2 * kPi * cutoff_hz * seconds)); }
  void update(double seconds, const Eigen::Vector3d& measured) override {
    velocity_ += share(1, seconds) * ((measured - place_) / seconds - velocity_);
    for (int axis = 0; axis < 3; ++axis)
      place_[axis] += share(cutoff_hz_ + beta_ * std::abs(velocity_[axis]), seconds) * (measured[axis] - place_[axis]);
  }
  double cutoff_hz_, beta_;
  bool goes_on_;
};

/// Fixed gains for place and velocity, and for acceleration where `gamma` isn't 0.
class AlphaBetaGamma final : public Moments {
 public:
  AlphaBetaGamma(double alpha, double beta, double gamma) : alpha_(alpha), beta_(beta), gamma_(gamma) {}
  /// Benedict and Bordner's velocity gain.
  static AlphaBetaGamma alpha_beta(double alpha) { return {alpha, alpha * alpha / (2 - alpha), 0}; }
  /// The gains of a fading memory with discount `theta` (Bar-Shalom, Li and Kirubarajan 2001).
  static AlphaBetaGamma fading(double theta) {
    const double rest = 1 - theta;
    return {1 - theta * theta * theta, 1.5 * rest * rest * (1 + theta), rest * rest * rest};
  }

 private:
  void update(double seconds, const Eigen::Vector3d& measured) override {
    place_ += velocity_ * seconds + acceleration_ * (0.5 * seconds * seconds);
    velocity_ += acceleration_ * seconds;
    const Eigen::Vector3d surprise = measured - place_;
    place_ += alpha_ * surprise;
    velocity_ += beta_ / seconds * surprise;
    acceleration_ += gamma_ / (seconds * seconds) * surprise;
  }
  double alpha_, beta_, gamma_;
};

/// Motion model of a head, for the Kalman filters.
struct HeadModel {
  enum Kind { velocity, acceleration, singer } kind = velocity;
  double disturbance = 0;  ///< spectral density (velocity: mm²/s³, acceleration: mm²/s⁵), or the acceleration's standard deviation
  double lasts_s = 0;      ///< singer: correlation time of the acceleration
};

/// One Kalman filter, or several that run side by side (interacting multiple models).
class Kalman final : public Contender {
 public:
  struct Habits {
    double changes_per_second = 2;
    double lead_share = 1;  ///< of the time ahead
    bool adapts = false;    ///< multiplies the disturbance by the ratio of recent innovations to expected ones
    double noise_mm = 1;
  };
  Kalman(std::vector<HeadModel> models, const Habits& habits)
      : models_(std::move(models)),
        habits_(habits),
        states_(models_.size()),
        chances_(models_.size(), 1.0 / static_cast<double>(models_.size())) {}

  void take(const HeadSample& sample) override {
    if (last_ns_ == 0)
      start(sample.between_eyes_mm);
    else
      update(static_cast<double>(sample.measured_ns - last_ns_) * 1e-9, sample.between_eyes_mm);
    last_ns_ = sample.measured_ns;
  }
  Eigen::Vector3d ahead(double seconds) const override {
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < states_.size(); ++i) moment += chances_[i] * states_[i].moment;
    const double lead = seconds * habits_.lead_share;
    return moment.row(0) + lead * moment.row(1) + 0.5 * lead * lead * moment.row(2);
  }

 private:
  struct State {
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  };
  static void step(const HeadModel& model, double factor, double t, State& state) {
    Eigen::Matrix3d forward = Eigen::Matrix3d::Identity(), noise = Eigen::Matrix3d::Zero();
    const double t2 = t * t, t3 = t2 * t, t4 = t3 * t;
    forward(0, 1) = t;
    if (model.kind == HeadModel::velocity) {
      forward(2, 2) = 0;
      noise.topLeftCorner<2, 2>() << t3 / 3, t2 / 2, t2 / 2, t;
      noise *= model.disturbance;
    } else {
      noise << t4 * t / 20, t4 / 8, t3 / 6, t4 / 8, t3 / 3, t2 / 2, t3 / 6, t2 / 2, t;
      const double rate = model.kind == HeadModel::singer ? 1 / model.lasts_s : 0;
      const double kept = std::exp(-rate * t);
      forward(0, 2) = rate > 0 ? (rate * t - 1 + kept) / (rate * rate) : t2 / 2;
      forward(1, 2) = rate > 0 ? (1 - kept) / rate : t;
      forward(2, 2) = kept;
      noise *= rate > 0 ? 2 * rate * model.disturbance * model.disturbance : model.disturbance;
    }
    state.moment = (forward * state.moment).eval();
    state.covariance = (forward * state.covariance * forward.transpose() + factor * noise).eval();
  }
  void start(const Eigen::Vector3d& measured) {
    for (State& state : states_) {
      state.moment.row(0) = measured.transpose();
      state.covariance.diagonal() << habits_.noise_mm * habits_.noise_mm, 1e4, 25e4;
    }
  }
  /// What each model starts from: the others', weighted by the probability that the head's motion has changed its model.
  std::vector<State> mixed(double seconds) {
    const std::size_t count = states_.size();
    const double change = count > 1 ? 1 - std::exp(-habits_.changes_per_second * seconds) : 0;
    std::vector<State> next(count);
    std::vector<double> chances(count, 0);
    for (std::size_t to = 0; to < count; ++to) {
      std::vector<double> weights(count);
      for (std::size_t from = 0; from < count; ++from) {
        weights[from] = chances_[from] * (from == to ? 1 - change : change / static_cast<double>(count - 1));
        chances[to] += weights[from];
      }
      for (std::size_t from = 0; from < count; ++from) next[to].moment += weights[from] / chances[to] * states_[from].moment;
      for (std::size_t from = 0; from < count; ++from) {
        const Eigen::Matrix3d apart = states_[from].moment - next[to].moment;
        next[to].covariance += weights[from] / chances[to] * (states_[from].covariance + apart * apart.transpose() / 3);
      }
    }
    chances_ = chances;
    return next;
  }
  void update(double seconds, const Eigen::Vector3d& measured) {
    states_ = mixed(seconds);
    double total = 0;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      State& state = states_[i];
      step(models_[i], factor_, seconds, state);
      const double expected = state.covariance(0, 0) + habits_.noise_mm * habits_.noise_mm;
      const Eigen::RowVector3d surprise = measured.transpose() - state.moment.row(0);
      const Eigen::Vector3d gain = state.covariance.col(0) / expected;
      state.moment += gain * surprise;
      state.covariance -= expected * gain * gain.transpose();
      const double ratio = surprise.squaredNorm() / (3 * expected);
      if (habits_.adapts) {
        surprises_ += 0.25 * (ratio - surprises_);
        factor_ = std::clamp(factor_ * std::pow(surprises_, 1.5), 1e-3, 30.0);
      }
      chances_[i] = std::max(1e-4, chances_[i] * (std::exp(-1.5 * ratio) / std::pow(expected, 1.5) + 1e-30));
      total += chances_[i];
    }
    for (double& chance : chances_) chance = std::max(1e-4, chance / total);
    total = 0;
    for (const double chance : chances_) total += chance;
    for (double& chance : chances_) chance /= total;
  }

  std::vector<HeadModel> models_;
  Habits habits_;
  std::vector<State> states_;
  std::vector<double> chances_;
  double surprises_ = 1, factor_ = 1;
  std::int64_t last_ns_ = 0;
};

}  // namespace prismesh::drivers::eye_tracker::bench
