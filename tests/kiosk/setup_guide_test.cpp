// The pages of the set-up without a window: their order, what is asked, and power cuts in the middle.
#include "kiosk/setup/guide.h"

#include <functional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ipc/setup/checks.h"

namespace prismesh::kiosk::setup {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

ipc::StationSetup new_station() {
  ipc::StationSetup station;
  station.due = true;
  station.name = "prismesh-12ab";
  station.profile = "mono";
  station.zone = "UTC";
  station.zones = {"America/New_York", "Asia/Tokyo", "Europe/Berlin", "Europe/Paris", "UTC"};
  station.date = "2026-11-28";
  station.time = "16:05";
  return station;
}
Facts mono() { return {"mono", false, false, false}; }
Facts mask() { return {"prism-mask", true, true, true}; }

/// Does on a station's settings what prismesh-setup does.
void carry_out(const ipc::SetupRequest& request, ipc::StationSetup& station) {
  if (const auto* m = std::get_if<ipc::SetName>(&request)) station.name = m->name;
  if (const auto* m = std::get_if<ipc::SetNetwork>(&request)) station.network = *m;
  if (const auto* m = std::get_if<ipc::SetProfile>(&request)) station.profile = m->profile;
  if (const auto* m = std::get_if<ipc::SetPairing>(&request)) station.pairing = m->on;
  if (const auto* m = std::get_if<ipc::SetZone>(&request)) station.zone = m->zone;
  if (const auto* m = std::get_if<ipc::SetClock>(&request)) station.date = m->date, station.time = m->time;
  if (const auto* m = std::get_if<ipc::KeepPage>(&request)) station.page = station.due ? m->page : station.page;
  if (std::holds_alternative<ipc::FinishSetup>(request)) station.due = false;
}

void clear_and_type(Guide& guide, const std::string& text) {
  for (int i = 0; i < 100; ++i) guide.erase();
  guide.type(text);
}
const Field& field(const View& view, const std::string& name) {
  for (const Field& each : view.fields)
    if (each.name == name) return each;
  ADD_FAILURE() << "no field " << name;
  static const Field kNone;
  return kNone;
}
void choose(Guide& guide, const std::string& label) {
  const View view = guide.view();
  for (std::size_t i = 0; i < view.choices.size(); ++i)
    if (view.choices[i].label == label) return guide.choose(i);
  ADD_FAILURE() << "no choice " << label;
}

TEST(SetupGuide, leads_through_the_pages_that_apply) {
  const auto pages = [](const ipc::StationSetup& station, const Facts& facts) {
    Guide guide(station, facts);
    std::vector<std::string> names{std::string(name_of(guide.page()))};
    const std::size_t count = guide.view().count;
    EXPECT_TRUE(guide.view().first);
    while (guide.page() != Page::done) {
      guide.skip();
      names.emplace_back(name_of(guide.page()));
      EXPECT_EQ(guide.view().number, names.size());
    }
    EXPECT_EQ(names.size(), count);
    guide.skip();
    EXPECT_EQ(guide.page(), Page::done) << "the last one can't be skipped";
    for (std::size_t i = names.size() - 1; i > 0; --i) {
      guide.back();
      EXPECT_EQ(name_of(guide.page()), names[i - 1]);
    }
    guide.back();
    EXPECT_EQ(guide.page(), Page::name);
    return names;
  };
  ipc::StationSetup station = new_station();
  EXPECT_THAT(pages(station, mono()), ElementsAre("name", "network", "profile", "zone", "clock", "pairing", "done"));
  station.clock_is_kept = true;
  EXPECT_THAT(pages(station, mask()), ElementsAre("name", "network", "profile", "calibration", "zone", "pairing", "done"));
}

TEST(SetupGuide, asks_for_nothing_that_is_set_already) {
  Guide guide(new_station(), mono());
  for (int presses = 0; guide.page() != Page::done && presses < 20; ++presses) {
    const auto request = guide.next();
    if (!request) continue;
    // The service may not be as the setting is, after a power cut between both.
    ASSERT_TRUE(std::holds_alternative<ipc::SetPairing>(*request)) << name_of(guide.page());
    EXPECT_FALSE(std::get<ipc::SetPairing>(*request).on);
    guide.answered({});
  }
  const auto finish = guide.next();
  ASSERT_TRUE(finish);
  EXPECT_TRUE(std::holds_alternative<ipc::FinishSetup>(*finish));
  EXPECT_FALSE(guide.finished());
  guide.answered({});
  EXPECT_TRUE(guide.finished());
}

TEST(SetupGuide, tells_what_is_wrong_at_the_field_and_stays) {
  Guide guide(new_station(), mono());
  clear_and_type(guide, "crash lab");
  EXPECT_FALSE(guide.next());
  EXPECT_EQ(guide.page(), Page::name);
  EXPECT_THAT(field(guide.view(), "name").trouble, HasSubstr("letters"));
  guide.erase();
  EXPECT_EQ(field(guide.view(), "name").trouble, "") << "it is being mended";
  clear_and_type(guide, "crash-lab");
  ASSERT_TRUE(guide.next());
  guide.answered({});
  EXPECT_EQ(guide.page(), Page::network);

  guide.choose(1);
  guide.type("10.0.0.2/24");
  guide.focus_next();
  guide.type("10.1.0.1");
  guide.focus(0);
  EXPECT_FALSE(guide.next());
  EXPECT_THAT(field(guide.view(), "gateway").trouble, HasSubstr("network of the address"));
  EXPECT_EQ(guide.view().focus, 1U) << "the wrong field is typed into";
  clear_and_type(guide, "10.0.0.1");
  guide.focus(2);
  guide.type("9.9.9.9, 10.0.0.1");
  const auto request = guide.next();
  ASSERT_TRUE(request);
  const auto& network = std::get<ipc::SetNetwork>(*request);
  EXPECT_THAT(network.dns, ElementsAre("9.9.9.9", "10.0.0.1"));
  guide.answered(fail("dns", "the disk is full"));
  EXPECT_EQ(field(guide.view(), "dns").trouble, "the disk is full");
  EXPECT_EQ(guide.page(), Page::network);
}

TEST(SetupGuide, shows_the_address_of_a_network_before_it_goes_on) {
  Guide guide(new_station(), mono());
  guide.skip();
  guide.choose(1);
  guide.type("10.0.0.2/24");
  ASSERT_TRUE(guide.next());
  EXPECT_FALSE(guide.next()) << "it is being written: a second press asks for nothing";
  guide.skip();
  guide.back();
  EXPECT_EQ(guide.page(), Page::network) << "nor leaves the page";
  guide.answered({});
  EXPECT_EQ(guide.page(), Page::network);
  guide.set_addresses({"10.0.0.2/24"});
  EXPECT_THAT(guide.view().remarks, testing::Contains(HasSubstr("10.0.0.2/24")));
  // One can go back to DHCP here.
  guide.choose(0);
  const auto request = guide.next();
  ASSERT_TRUE(request);
  EXPECT_TRUE(std::get<ipc::SetNetwork>(*request).dhcp);
  guide.answered({});
  EXPECT_FALSE(guide.next());
  EXPECT_EQ(guide.page(), Page::profile);
}

TEST(SetupGuide, a_profile_with_depth_brings_the_calibration) {
  Guide guide(new_station(), mono());
  guide.skip();
  guide.skip();
  choose(guide, "prism-mask");
  const auto request = guide.next();
  ASSERT_TRUE(request);
  EXPECT_EQ(std::get<ipc::SetProfile>(*request).profile, "prism-mask");
  guide.answered({});
  EXPECT_EQ(guide.page(), Page::calibration);
  EXPECT_FALSE(guide.view().can_calibrate) << "no mask answers";
  EXPECT_EQ(guide.view().next, "Later");
  guide.set_facts(mask());
  EXPECT_TRUE(guide.view().can_calibrate);
  guide.calibrated("The calibration is saved.");
  EXPECT_THAT(guide.view().remarks, ElementsAre("The calibration is saved."));
  EXPECT_FALSE(guide.next());
  EXPECT_EQ(guide.page(), Page::zone);
}

TEST(SetupGuide, the_clock_page_tells_what_the_clock_says_when_it_is_shown) {
  Guide guide(new_station(), mono());
  while (guide.page() != Page::zone) guide.skip();
  EXPECT_FALSE(guide.wants_clock());
  guide.type("paris");
  ASSERT_TRUE(guide.next());
  guide.answered({});
  ASSERT_EQ(guide.page(), Page::clock);
  EXPECT_TRUE(guide.wants_clock());
  ipc::StationSetup now = new_station();
  now.time = "17:07";
  guide.set_clock(now);
  EXPECT_FALSE(guide.wants_clock());
  EXPECT_EQ(field(guide.view(), "time").text, "17:07");
  // What is typed counts, also where it is what stood there.
  guide.erase();
  guide.type("8");
  const auto request = guide.next();
  ASSERT_TRUE(request);
  EXPECT_EQ(std::get<ipc::SetClock>(*request).time, "17:07");
  guide.answered({});
  guide.back();
  EXPECT_TRUE(guide.wants_clock()) << "each time anew";
  guide.focus(1);
  clear_and_type(guide, "09:00");
  guide.set_clock(now);
  EXPECT_EQ(field(guide.view(), "time").text, "09:00") << "what is being typed stays";
  guide.back();
  guide.skip();
  now.clock_is_kept = true;
  guide.set_clock(now);
  EXPECT_EQ(guide.page(), Page::pairing) << "a server has answered meanwhile";
}

TEST(SetupGuide, every_built_in_profile_is_offered_and_a_calibrated_one_stays) {
  Guide guide(new_station(), {"/var/lib/prismesh-kiosk/prismesh/displays/ours.toml", true, true, true});
  guide.skip();
  guide.skip();
  const View view = guide.view();
  EXPECT_EQ(view.choices.front().label, "As it is");
  EXPECT_EQ(view.chosen, 0U);
  EXPECT_EQ(view.choices.size(), 12U);
  for (std::size_t i = 1; i < view.choices.size(); ++i) {
    EXPECT_TRUE(ipc::check_profile(view.choices[i].label)) << view.choices[i].label;
    EXPECT_FALSE(view.choices[i].words.empty()) << view.choices[i].label;
  }
  EXPECT_FALSE(guide.next()) << "as it is";
  EXPECT_EQ(guide.page(), Page::calibration);
}

TEST(SetupGuide, shows_the_code_once_pairing_is_on) {
  Guide guide(new_station(), mono());
  while (guide.page() != Page::pairing) guide.skip();
  EXPECT_FALSE(guide.wants_code());
  choose(guide, "On");
  const auto request = guide.next();
  ASSERT_TRUE(request);
  EXPECT_TRUE(std::get<ipc::SetPairing>(*request).on);
  guide.answered({});
  EXPECT_EQ(guide.page(), Page::pairing);
  EXPECT_TRUE(guide.wants_code());
  guide.set_code({"YH00-XEMD"});
  EXPECT_FALSE(guide.wants_code());
  EXPECT_THAT(guide.view().remarks, testing::Contains("YH00-XEMD"));
  EXPECT_FALSE(guide.next());
  EXPECT_EQ(guide.page(), Page::done);
  guide.back();
  EXPECT_EQ(guide.view().chosen, 1U) << "it is on";
  choose(guide, "Off");
  const auto off = guide.next();
  ASSERT_TRUE(off);
  EXPECT_FALSE(std::get<ipc::SetPairing>(*off).on);
  guide.answered({});
  EXPECT_EQ(guide.page(), Page::done);
}

TEST(SetupGuide, finds_zones_by_what_is_typed) {
  Guide guide(new_station(), mono());
  while (guide.page() != Page::zone) guide.skip();
  EXPECT_EQ(guide.view().choices[guide.view().chosen].label, "UTC") << "the one that is set";
  guide.type("new y");
  EXPECT_EQ(guide.view().choices.size(), 1U);
  const auto request = guide.next();
  ASSERT_TRUE(request);
  EXPECT_EQ(std::get<ipc::SetZone>(*request).zone, "America/New_York");
  guide.answered(fail("zone", "there is no such zone"));
  clear_and_type(guide, "atlantis");
  EXPECT_TRUE(guide.view().choices.empty());
  EXPECT_FALSE(guide.next());
  EXPECT_EQ(guide.page(), Page::zone);
  EXPECT_FALSE(guide.view().trouble.empty());
  guide.step(1);
  guide.choose(0);
  clear_and_type(guide, "ber");
  guide.step(-5);
  EXPECT_EQ(guide.view().choices[guide.view().chosen].label, "Europe/Berlin");
}

TEST(SetupGuide, takes_whole_letters_away_and_no_endless_text) {
  Guide guide(new_station(), mono());
  clear_and_type(guide, "a\xc3\xa4");
  guide.erase();
  EXPECT_EQ(field(guide.view(), "name").text, "a");
  for (int i = 0; i < 1000; ++i) guide.type("x");
  EXPECT_LE(field(guide.view(), "name").text.size(), 80U);
}

TEST(SetupGuide, a_kept_page_that_does_not_apply_leads_to_the_next_one) {
  ipc::StationSetup station = new_station();
  station.page = "calibration";
  EXPECT_EQ(Guide(station, mono()).page(), Page::zone);
  station.page = "clock";
  station.clock_is_kept = true;
  EXPECT_EQ(Guide(station, mono()).page(), Page::pairing);
  station.page = "nonsense";
  EXPECT_EQ(Guide(station, mono()).page(), Page::name);
}

/// What a person does who wants a certain station, on whatever page the set-up stands.
std::optional<ipc::SetupRequest> press_next(Guide& guide) {
  switch (guide.page()) {
    case Page::name: clear_and_type(guide, "crash-lab"); break;
    case Page::network:
      guide.choose(1);
      for (const auto& [at, text] : {std::pair<std::size_t, const char*>{0, "10.0.0.2/24"}, {1, "10.0.0.1"}}) {
        guide.focus(at);
        clear_and_type(guide, text);
      }
      break;
    case Page::profile: choose(guide, "lenticular"); break;
    case Page::pairing:
      if (!guide.view().choices.empty()) choose(guide, "On");
      break;
    case Page::zone: clear_and_type(guide, "paris"); break;
    case Page::clock:
      guide.focus(1);
      clear_and_type(guide, "17:30");
      break;
    case Page::calibration:
    case Page::done: break;
  }
  return guide.next();
}

/// Sets a station up. Before the `cut`th write, or after it if `done`, the power goes; nothing of the program stays. Returns whether the
/// power went.
bool set_up_until(int cut, bool done, ipc::StationSetup& station, std::vector<std::string>& shown) {
  int writes = 0;
  const auto write = [&](const ipc::SetupRequest& request) {
    const bool now = ++writes == cut;
    if (!now || done) carry_out(request, station);
    return !now;
  };
  const auto facts = [&] {
    const bool stereo = station.profile != "mono";
    return Facts{station.profile, stereo, false, false};
  };
  Guide guide(station, facts());
  std::string kept;
  for (int turns = 0; turns < 100 && !guide.finished(); ++turns) {
    const std::string page(name_of(guide.page()));
    shown.push_back(page);
    if (std::exchange(kept, page) != page && !write(ipc::KeepPage{page})) return true;
    if (const auto request = press_next(guide)) {
      if (!write(*request)) return true;
      guide.answered({});
    }
  }
  EXPECT_TRUE(guide.finished());
  return false;
}

TEST(SetupGuide, goes_on_after_a_power_cut_at_any_moment) {
  int cuts = 0;
  for (const bool done : {false, true}) {
    for (int cut = 1;; ++cut) {
      ipc::StationSetup station = new_station();
      std::vector<std::string> before, after;
      if (!set_up_until(cut, done, station, before)) break;
      ++cuts;
      if (station.due) {
        EXPECT_FALSE(set_up_until(0, false, station, after));
        // Where it stopped, or one page before if that one wasn't kept yet.
        const auto stopped = before.back();
        const bool there = after.front() == stopped || (before.size() > 1 && after.front() == before[before.size() - 2]);
        EXPECT_TRUE(there) << "stopped at " << stopped << ", went on at " << after.front();
      }
      EXPECT_FALSE(station.due);
      EXPECT_EQ(station.name, "crash-lab");
      EXPECT_EQ(station.network.address, "10.0.0.2/24");
      EXPECT_EQ(station.profile, "lenticular");
      EXPECT_TRUE(station.pairing);
      EXPECT_EQ(station.zone, "Europe/Paris");
      EXPECT_EQ(station.time, "17:30");
    }
  }
  EXPECT_GT(cuts, 20);
}

}  // namespace
}  // namespace prismesh::kiosk::setup
