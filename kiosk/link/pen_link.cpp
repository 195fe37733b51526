#include "kiosk/link/pen_link.h"

#include <variant>

#include <fmt/format.h>

namespace prismesh::kiosk::link {

PenLink::PenLink(const std::filesystem::path& socket, Connection& model, Clock& clock, notices::Trace trace)
    : connection_(socket, "prismesh-kiosk"),
      model_(model),
      clock_(clock),
      trace_(trace),
      // The pen's process may have read a field of an earlier kiosk, so its numbers aren't used again: far fewer than a thousand places a
      // second are told.
      number_(static_cast<std::uint64_t>(clock.now_ns()) / 1'000'000) {
  model_.add(*this);
}

void PenLink::turn() {
  client_ = connection_.client();
  if (client_ != nullptr && connection_.connections() != greeted_) greet();
  if (client_ == nullptr) return;
  if (const Result<void> polled = client_->poll(); !polled) return pen_lost(polled.error());
  while (client_ != nullptr) {
    if (const auto reply = client_->next_reply())
      take(*reply);
    else if (const auto event = client_->next_event())
      take(std::get<ipc::PenChanged>(*event).pen);
    else
      break;
  }
  follow();
}

void PenLink::greet() {
  greeted_ = connection_.connections();
  ++changes_;
  followed_.reset();
  attached_ = {};
  trace_.line("pen connected");
  send(ipc::GetPen{});
}

void PenLink::pen_lost(const Error& why) {
  connection_.lost(why);
  client_ = nullptr;
  info_.reset();
  arming_.clear();
  followed_.reset();
  attached_ = {};
  ++changes_;
  trace_.line("pen disconnected " + why.text());
}

std::optional<std::uint64_t> PenLink::send(const ipc::PenRequest& request) {
  if (client_ == nullptr) return std::nullopt;
  const Result<std::uint64_t> sent = client_->send(request);
  if (sent) return *sent;
  pen_lost(sent.error());
  return std::nullopt;
}

void PenLink::take(const ipc::PenClient::Reply& reply) {
  const bool armed = arming_.erase(reply.request) > 0;
  if (const auto* failed = std::get_if<ipc::Failed>(&reply.answer)) {
    trace_.line("pen refused " + failed->message);
    if (armed) refusal_ = failed->message;
    ++changes_;
  }
  if (const auto* pen = std::get_if<ipc::Pen>(&reply.answer)) take(pen->pen);
}

void PenLink::take(const ipc::PenInfo& info) {
  if (info_ == info) return;
  info_ = info;
  ++changes_;
  trace_.line("pen state " + info.state);
}

std::optional<ipc::PenState> PenLink::state() const { return client_ != nullptr && has_pen() ? client_->page().state() : std::nullopt; }

void PenLink::arm() {
  if (const auto sent = send(ipc::ArmPen{})) arming_.insert(*sent);
}

void PenLink::disarm() {
  if (const auto sent = send(ipc::DisarmPen{})) arming_.insert(*sent);
}

void PenLink::forget_model() {
  asking_ = false;
  followed_.reset();
  attached_ = {};
}

void PenLink::follow() {
  if (client_ == nullptr || !has_pen() || !model_.connected() || !wanted_ || asking_ || wanted_ == followed_) return;
  const std::int64_t now = clock_.now_ns();
  if (followed_ && now - told_ns_ < kPlacePeriodNs) return;
  told_ns_ = now;
  const ipc::FollowPen request{++number_, wanted_->turn, wanted_->shift_mm, wanted_->scale};
  asking_ = true;
  followed_ = wanted_;
  model_.follow_pen(request, client_->page_descriptor(), [this](const ipc::Answer& answer) { followed(answer); });
}

/// The pen's process may have ended meanwhile: then the page is asked for anew.
void PenLink::followed(const ipc::Answer& answer) {
  asking_ = false;
  if (const auto* failed = std::get_if<ipc::Failed>(&answer)) return trace_.line("pen refused " + failed->message);
  const auto* done = std::get_if<ipc::PenFollowed>(&answer);
  if (done == nullptr) return;
  Result<ipc::Descriptor> page = model_.take(*done);
  if (!page) return trace_.line("pen refused " + page.error().text());
  if (client_ == nullptr || !followed_) return;
  const auto& [turn, shift, scale, document] = *followed_;
  trace_.line(fmt::format("pen placed {} turn {} {} {} {} shift {} {} {} scale {}", number_, turn[0], turn[1], turn[2], turn[3], shift[0],
                          shift[1], shift[2], scale));
  if (attached_.same_file(*page)) return;
  if (const Result<std::uint64_t> sent = client_->send_field(*page); !sent) return pen_lost(sent.error());
  attached_ = std::move(*page);
  trace_.line("pen feels");
}

}  // namespace prismesh::kiosk::link
