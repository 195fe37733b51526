// Compares how well filters predict the head: errors, not times. Each filter on the same seeds: fast turns, sway, leaning, sitting still,
// each a minute at 60 Hz with 1 mm of noise in each axis; medians over the seeds. `eye_filter_bench 200` takes 200 seeds.
// docs/prediction.md holds the table.
#include <time.h>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tests/bench/eye_filters.h"
#include "tests/support/head_trials.h"

namespace prismesh::drivers::eye_tracker::bench {
namespace {

struct Entry {
  std::string name;
  std::function<std::unique_ptr<Contender>()> make;
};

Entry kalman(std::string name, const std::vector<HeadModel>& models, const Kalman::Habits& habits = {}) {
  return {std::move(name), [models, habits] { return std::make_unique<Kalman>(models, habits); }};
}

std::vector<Entry> entries() {
  using Kind = HeadModel::Kind;
  std::vector<Entry> all;
  all.push_back({"raw", [] { return std::make_unique<Raw>(); }});
  all.push_back({"one-euro (1.5 Hz, 0.05)", [] { return std::make_unique<OneEuro>(1.5, 0.05, false); }});
  all.push_back({"one-euro + velocity", [] { return std::make_unique<OneEuro>(1.5, 0.05, true); }});
  for (const double alpha : {0.35, 0.5, 0.6})
    all.push_back({"alpha-beta " + std::to_string(alpha).substr(0, 4),
                   [alpha] { return std::make_unique<AlphaBetaGamma>(AlphaBetaGamma::alpha_beta(alpha)); }});
  for (const double theta : {0.7, 0.8})
    all.push_back({"alpha-beta-gamma, memory " + std::to_string(theta).substr(0, 3),
                   [theta] { return std::make_unique<AlphaBetaGamma>(AlphaBetaGamma::fading(theta)); }});
  const HeadModel resting{Kind::velocity, 30, 0}, moving{Kind::singer, 900, 0.2};
  all.push_back(kalman("Kalman CV 3e4", {{Kind::velocity, 3e4, 0}}));
  all.push_back(kalman("Kalman CV 5e5", {{Kind::velocity, 5e5, 0}}));
  all.push_back(kalman("Kalman CV 3e4, adaptive", {{Kind::velocity, 3e4, 0}}, {.adapts = true}));
  all.push_back(kalman("Kalman CA 3e6", {{Kind::acceleration, 3e6, 0}}));
  all.push_back(kalman("Kalman Singer 900", {moving}));
  all.push_back(kalman("IMM CV 30 + CV 3e5", {resting, {Kind::velocity, 3e5, 0}}));
  all.push_back(kalman("IMM CV 30 + CA 1e7", {resting, {Kind::acceleration, 1e7, 0}}));
  all.push_back(kalman("IMM CV 30 + CV 1e4 + Singer", {resting, {Kind::velocity, 1e4, 0}, moving}));
  all.push_back(kalman("IMM CV 30 + Singer 900", {resting, moving}));
  all.push_back(kalman("IMM CV 30 + Singer, lead 0.8", {resting, moving}, {.lead_share = 0.8}));
  all.push_back({"shipped: IMM, lead 0.95", [] { return std::make_unique<Shipped>(); }});
  return all;
}

double cpu_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e9 + static_cast<double>(time.tv_nsec);
}

double cost_of_a_sample_ns(const Entry& entry) {
  const auto filter = entry.make();
  HeadSample sample;
  constexpr int kSamples = 100'000;
  const double begin = cpu_ns();
  for (int i = 0; i < kSamples; ++i) {
    sample.measured_ns = 1'000'000'000 + i * std::int64_t{16'666'667};
    sample.between_eyes_mm.x() = (i * 7919) % 13 * 0.2;
    filter->take(sample);
  }
  return (cpu_ns() - begin) / kSamples;
}

class Medians {
 public:
  void add(double value) { values_.push_back(value); }
  double value() const { return trials::quantile(values_, 0.5); }

 private:
  std::vector<double> values_;
};

void print_row(const Entry& entry, int seeds) {
  constexpr double kAhead[] = {0.035, 0.05, 0.08};
  Medians middle[3], most[3], worst[3], across, sway, lean, jitter, beyond;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto on = [&](MotionKind kind, double ahead_s) {
      const auto filter = entry.make();
      return trials::run({.kind = kind, .seed = static_cast<std::uint64_t>(seed), .ahead_s = ahead_s}, *filter);
    };
    for (int i = 0; i < 3; ++i) {
      const trials::Errors errors = on(MotionKind::turn, kAhead[i]);
      middle[i].add(trials::quantile(errors.distances_mm, 0.5));
      most[i].add(trials::quantile(errors.distances_mm, 0.99));
      worst[i].add(trials::quantile(errors.distances_mm, 1));
      if (i != 1) continue;
      across.add(trials::quantile(errors.across_mm, 0.99));
      beyond.add(trials::quantile(errors.beyond_mm, 0.99));
    }
    sway.add(trials::quantile(on(MotionKind::sway, 0.05).distances_mm, 0.99));
    lean.add(trials::quantile(on(MotionKind::lean, 0.05).distances_mm, 0.99));
    jitter.add(on(MotionKind::still, 0.05).jitter_mm);
  }
  std::printf("| %-30s |", entry.name.c_str());
  for (int i = 0; i < 3; ++i) std::printf(" %4.1f / %4.1f / %4.1f |", middle[i].value(), most[i].value(), worst[i].value());
  std::printf(" %4.1f | %4.1f | %4.1f | %4.1f | %5.2f | %5.0f |\n", across.value(), sway.value(), lean.value(), beyond.value(),
              jitter.value(), cost_of_a_sample_ns(entry));
  std::fflush(stdout);
}

}  // namespace
}  // namespace prismesh::drivers::eye_tracker::bench

int main(int count, char** words) {
  const int seeds = count > 1 ? std::max(1, std::atoi(words[1])) : 100;
  std::printf("Medians over %d seeds of the distance, in mm, between the foretold place and the head's.\n\n", seeds);
  std::printf(
      "| filter | turn, 35 ms ahead: p50 / p99 / max | 50 ms | 80 ms | 50 ms, p99: across | sway | lean | beyond after a stop | jitter at "
      "rest | ns a sample |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto& entry : prismesh::drivers::eye_tracker::bench::entries()) prismesh::drivers::eye_tracker::bench::print_row(entry, seeds);
  return 0;
}
