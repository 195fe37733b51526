// The pages of a station's set-up in their order, what is typed and chosen on them, and what is asked of prismesh-setup. It uses no window
// and no socket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "ipc/setup/messages.h"

namespace prismesh::kiosk::setup {

/// In their order. Pairing comes after the clock: what it gives is good for a time.
enum class Page : std::uint8_t { name, network, profile, calibration, zone, clock, pairing, done };
/// As it is kept over a power cut.
std::string_view name_of(Page page);

/// The keys that a page without a keyboard shows for a field.
enum class Pad : std::uint8_t { letters, addresses, digits };

struct Field {
  std::string name;   ///< as errors name it
  std::string label;  ///< before it
  std::string text;
  std::string trouble;  ///< why it can't be taken; empty: nothing is wrong
  Pad pad = Pad::letters;
};

struct Choice {
  std::string label;
  std::string words;  ///< what it is; may be empty
};

/// What a page shows.
struct View {
  std::size_t number = 1, count = 1;
  std::string title;
  std::string task;  ///< what to do, in a sentence or two
  std::vector<Choice> choices;
  std::size_t chosen = 0;
  bool finds = false;  ///< the choices are what fits the field
  std::vector<Field> fields;
  std::size_t focus = 0;             ///< the field that is typed into
  std::vector<std::string> remarks;  ///< what is now, and what was done
  std::string trouble;               ///< why it doesn't go on, where no field is wrong
  std::string next;                  ///< label of the button to the next page
  bool first = false, can_skip = true, can_calibrate = false;
};

/// What this display and its devices can do.
struct Facts {
  std::string profile;        ///< that the kiosk draws with, as the settings name it
  bool stereo = false;        ///< it shows depth
  bool mask_moves = false;    ///< by a servo
  bool mask_answers = false;  ///< that servo is there
};

class Guide {
 public:
  /// Goes on at the page that `station` tells.
  Guide(const ipc::StationSetup& station, const Facts& facts);

  Page page() const { return page_; }
  const std::string& profile() const { return facts_.profile; }  ///< that is set
  View view() const;
  void set_facts(const Facts& facts) { facts_ = facts; }
  /// Those of the machine now, with prefixes.
  void set_addresses(std::vector<std::string> addresses) { addresses_ = std::move(addresses); }
  bool finished() const { return finished_; }

  // --- the hands ---
  void type(std::string_view text);  ///< at the end of the field that is typed into; UTF-8
  void erase();                      ///< its last letter
  void focus(std::size_t field);
  void focus_next();
  void choose(std::size_t choice);
  void step(int by);  ///< to a choice farther down or up
  void skip();        ///< keeps what is set
  void back();
  /// Checks what the page says. Returns what to ask; nothing: something is wrong, or nothing is to be changed, and the next page is shown.
  std::optional<ipc::SetupRequest> next();
  /// Whether that was done: then the next page is shown. Errors stand at the field that they name.
  void answered(const Result<void>& done);

  /// The clock page is shown, and it isn't known what the clock says now: the zone may be another, and a server may have answered.
  bool wants_clock() const { return page_ == Page::clock && !clock_known_; }
  /// What the clock says now. One that a server keeps isn't set by hand: then the next page is shown.
  void set_clock(const ipc::StationSetup& now);

  /// A pairing code is to be shown, and there is none yet.
  bool wants_code() const { return page_ == Page::pairing && shows_code_ && code_.empty(); }
  void set_code(std::vector<std::string> words) { code_ = std::move(words); }
  /// A calibration has ended: how, in a sentence.
  void calibrated(std::string how);

 private:
  bool applies(Page page) const;
  void go(int by);
  void enter(Page page);
  void tell(const Error& error);
  void take_profile(const std::string& name);
  void filter_zones();
  ipc::SetNetwork typed_network() const;
  std::optional<ipc::SetupRequest> request() const;
  std::vector<Choice> choices() const;

  ipc::StationSetup station_;  ///< as it is set now
  Facts facts_;
  std::vector<std::string> addresses_;
  Page page_ = Page::name;
  std::vector<Field> fields_;
  std::size_t focus_ = 0;
  std::size_t chosen_ = 0;
  std::vector<std::string> zones_;  ///< that fit what was typed
  std::string trouble_;
  std::string calibration_;  ///< how it ended
  std::vector<std::string> code_;
  bool shows_code_ = false;
  bool network_set_ = false;  ///< on this page
  bool clock_known_ = false;  ///< on this page
  bool typed_ = false;        ///< on this page, into a field
  std::optional<ipc::SetupRequest> asked_;
  bool finished_ = false;
};

}  // namespace prismesh::kiosk::setup
