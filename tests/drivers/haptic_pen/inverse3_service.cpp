#include "tests/drivers/haptic_pen/inverse3_service.h"

#include <sys/socket.h>

#include <algorithm>
#include <chrono>
#include <mutex>
#include <thread>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <nlohmann/json.hpp>

namespace prismesh::drivers::haptic_pen::inverse3 {

namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using nlohmann::json;

json xyz(const Eigen::Vector3d& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

}  // namespace

struct InverseService::Impl {
  explicit Impl(std::uint16_t port) : acceptor(io, tcp::endpoint(asio::ip::address_v4::loopback(), port)) {
    thread = std::thread([this] { serve(); });
  }
  ~Impl() {
    {
      const std::lock_guard lock(mutex);
      ended = true;
      ::shutdown(acceptor.native_handle(), SHUT_RDWR);
      for (const int each : open) ::shutdown(each, SHUT_RDWR);
    }
    thread.join();
    for (std::thread& each : clients) each.join();
  }

  void serve() {
    for (;;) {
      tcp::socket socket(io);
      boost::system::error_code error;
      acceptor.accept(socket, error);
      const std::lock_guard lock(mutex);
      if (ended || error) return;
      ++seen.connections;
      open.push_back(socket.native_handle());
      clients.emplace_back([this, taken = std::move(socket)]() mutable { talk(std::move(taken)); });
    }
  }

  void talk(tcp::socket socket) {
    const int descriptor = socket.native_handle();
    websocket::stream<tcp::socket> stream(std::move(socket));
    boost::system::error_code error;
    stream.accept(error);
    if (!error) stream.write(asio::buffer(message(true)), error);
    while (!error) {
      boost::beast::flat_buffer buffer;
      stream.read(buffer, error);
      if (error) break;
      take(boost::beast::buffers_to_string(buffer.data()));
      int delay_ms = 0;
      bool answers = true;
      {
        const std::lock_guard lock(mutex);
        delay_ms = played.answer_delay_ms;
        answers = played.answers;
      }
      if (delay_ms > 0) std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
      if (answers) stream.write(asio::buffer(message(false)), error);
    }
    const std::lock_guard lock(mutex);
    std::erase(open, descriptor);
  }

  void take(const std::string& text) {
    const std::lock_guard lock(mutex);
    ++seen.messages;
    seen.last_text = text;
    const json root = json::parse(text, nullptr, false);
    const char* vector = played.since_3_5 ? "vector" : "values";
    try {
      const json& one = root.at("inverse3").at(0);
      const json& force = one.at("commands").at("set_cursor_force").at(vector);
      seen.newton = {force.at("x").get<double>(), force.at("y").get<double>(), force.at("z").get<double>()};
      const auto id = one.at("device_id").get<std::string>();
      if (std::find(played.devices.begin(), played.devices.end(), id) == played.devices.end()) seen.well_formed = false;
    } catch (const json::exception&) {
      seen.well_formed = false;
    }
    seen.longest_newton = std::max(seen.longest_newton, seen.newton.norm());
  }

  std::string message(bool first) {
    const std::lock_guard lock(mutex);
    if (first && !played.greeting_instead.empty()) return played.greeting_instead;
    if (!first && !played.instead.empty()) return played.instead;
    json root{{"inverse3", json::array()}};
    if (played.since_3_5) root["session_id"] = 7;
    for (const std::string& id : played.devices) {
      json one{{"device_id", id},
               {"state",
                {{"cursor_position", xyz(played.position_m + played.metres_per_newton * seen.newton)},
                 {"cursor_velocity", xyz(Eigen::Vector3d::Zero())},
                 {"body_orientation", {{"w", 1.0}, {"x", 0.0}, {"y", 0.0}, {"z", 0.0}}},
                 {"transform", json::object()}}},
               {"status", {{"ready", played.ready}, {"power_supply", played.powered}, {"in_use", played.in_use}, {"calibrated", true}}}};
      if (first) one["config"] = {{"type", "inverse3"}, {"handedness", "right"}, {"basis", {{"permutation", played.basis}}}};
      root["inverse3"].push_back(std::move(one));
    }
    std::string text = root.dump();
    if (!played.grips.empty()) text.insert(text.size() - 1, played.grips);
    return text;
  }

  asio::io_context io;
  tcp::acceptor acceptor;
  mutable std::mutex mutex;
  PlayedService played;
  SeenByService seen;
  std::vector<int> open;
  std::vector<std::thread> clients;
  bool ended = false;
  std::thread thread;
};

InverseService::InverseService(std::uint16_t port) : impl_(std::make_unique<Impl>(port)) {}
InverseService::~InverseService() = default;

std::uint16_t InverseService::port() const { return impl_->acceptor.local_endpoint().port(); }

void InverseService::play(const std::function<void(PlayedService&)>& change) {
  const std::lock_guard lock(impl_->mutex);
  change(impl_->played);
}

SeenByService InverseService::seen() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->seen;
}

}  // namespace prismesh::drivers::haptic_pen::inverse3
