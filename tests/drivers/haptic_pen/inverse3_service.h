// Plays the Haply Inverse Service: a websocket server that shares no code with the driver, with a hand that holds each Inverse3.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace prismesh::drivers::haptic_pen::inverse3 {

/// All in the service's axes.
struct PlayedService {
  std::vector<std::string> devices{"049D"};
  Eigen::Vector3d position_m{0.01, -0.10, 0.18};
  double metres_per_newton = 0;  ///< how far a force carries the grip from there
  std::string grips;             ///< JSON behind the devices, with a comma before it
  bool ready = true, powered = true, in_use = false, since_3_5 = true;
  std::string basis = "XYZ";
  bool answers = true;
  int answer_delay_ms = 0;
  std::string instead;  ///< of an answer; empty: the right one
  std::string greeting_instead;
};

struct SeenByService {
  std::uint64_t connections = 0, messages = 0;
  std::string last_text;
  Eigen::Vector3d newton = Eigen::Vector3d::Zero();  ///< the last force
  double longest_newton = 0;
  bool well_formed = true;  ///< each message was for a device that there is
};

class InverseService {
 public:
  /// 0: any free port.
  explicit InverseService(std::uint16_t port = 0);
  /// Ends all connections, as a service does that is stopped.
  ~InverseService();
  InverseService(const InverseService&) = delete;
  InverseService& operator=(const InverseService&) = delete;

  std::uint16_t port() const;
  /// Changes what it plays.
  void play(const std::function<void(PlayedService&)>& change);
  SeenByService seen() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prismesh::drivers::haptic_pen::inverse3
