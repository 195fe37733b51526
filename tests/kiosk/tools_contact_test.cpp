// The list of places where parts touch, its words, and what a pull touches in words.
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ipc/model/messages_json.h"
#include "ipc/model/state_page.h"
#include "ipc/wire/server.h"
#include "kiosk/tools/contact/contact_link.h"
#include "kiosk/tools/contact/contact_panel.h"
#include "kiosk/tools/contact/contact_tool.h"
#include "kiosk/tools/contact/contact_words.h"
#include "kiosk/tools/shaping/touch_words.h"
#include "tests/kiosk/gui_test.h"

namespace prismesh::kiosk::tools::contact {
namespace {

constexpr display::PixelSize kContactPicture{900, 700};

ipc::Contacts three_places() {
  ipc::Contacts contacts;
  contacts.generation = 3;
  contacts.perforations = 1, contacts.penetrations = 1, contacts.clearances = 1;
  for (const char* kind : {"perforation", "penetration", "clearance"}) {
    ipc::ContactRegion region;
    region.kind = kind;
    region.a = "part:7", region.name_a = "Roof";
    region.b = "part:9", region.name_b = "Rail";
    region.max_depth = 0.8;
    region.shells = {1, 2};
    region.curve = {{0, 0, 0, 1, 0, 0}};
    region.vectors = {{4, {1, 2, 3}}, {99, {0, 0, 0}}};
    contacts.regions.push_back(region);
  }
  contacts.regions[1].shells = {5, 6, 7};
  contacts.regions[1].curve.clear();
  contacts.regions[1].joined = true;
  return contacts;
}

TEST(ContactWords, name_kind_depth_and_parts) {
  ipc::Contacts contacts = three_places();
  EXPECT_EQ(region_words(contacts.regions[0], "mm"), "cross, 0.8 mm deep: 7 Roof and 9 Rail");
  EXPECT_EQ(region_words(contacts.regions[1], "mm"), "too close, 0.8 mm deep: 7 Roof and 9 Rail, joined");
  EXPECT_EQ(region_words(contacts.regions[2], "mm"), "gap, 0.8 mm short of the gap: 7 Roof and 9 Rail");
  contacts.regions[0].max_depth.reset();
  contacts.regions[0].a.clear();
  contacts.regions[0].name_b = "bad\x01";
  EXPECT_EQ(region_words(contacts.regions[0], "mm"), "cross, half through: no part and 9 bad\\x01");
  EXPECT_EQ(row_words(contacts.regions[0], "mm"), "half through: no part, 9 bad\\x01");
  EXPECT_EQ(row_words(contacts.regions[1], "mm"), "0.8 mm: 7 Roof, 9 Rail, joined");
  EXPECT_EQ(count_words(contacts), "1 cross, 1 too close, 1 within the gap");
  EXPECT_EQ(count_words({}), "nothing crosses or is too close");
}

TEST(ContactPicture, has_the_ways_out_of_the_chosen_region_only) {
  const ipc::Contacts contacts = three_places();
  const auto position = [](std::uint32_t node) { return node < 10 ? std::optional(mesh::Vec3(node, 0, 0)) : std::nullopt; };
  const render::ContactPicture none = picture_of(contacts, std::nullopt, position);
  EXPECT_TRUE(none.chosen.empty());
  EXPECT_EQ(none.shells.size(), 7u);
  EXPECT_EQ(none.curve.size(), 2u);
  EXPECT_TRUE(none.vectors.empty());
  const render::ContactPicture second = picture_of(contacts, 1, position);
  EXPECT_EQ(second.chosen, (std::vector<mesh::ShellIndex>{mesh::ShellIndex(5u), mesh::ShellIndex(6u), mesh::ShellIndex(7u)}));
  EXPECT_EQ(second.shells.size(), 4u);
  ASSERT_EQ(second.vectors.size(), 1u) << "node 99 doesn't exist";
  EXPECT_EQ(second.vectors[0][0], mesh::Vec3(4, 0, 0));
  EXPECT_EQ(second.vectors[0][1], mesh::Vec3(1, 2, 3));
}

/// Welcomes its client and counts how often it is asked for contacts.
class ContactServer final : public ipc::ServerHandler {
 public:
  explicit ContactServer(const std::filesystem::path& socket)
      : page_(ipc::StatePage::create().value()), server_(ipc::Server::listen(socket, *this).value()) {
    thread_ = std::thread([this] { server_.run(); });
  }
  ~ContactServer() override {
    server_.stop();
    thread_.join();
  }
  void connected(ipc::ClientId) override {}
  void disconnected(ipc::ClientId, const std::string&) override {}
  void line(ipc::ClientId client, std::string_view text) override {
    const auto request = ipc::decode_request(text);
    ASSERT_TRUE(request) << request.error().message;
    if (std::holds_alternative<ipc::Hello>(request->request)) {
      std::vector<ipc::Descriptor> descriptors;
      descriptors.push_back(page_.descriptor().duplicate().value());
      server_.send(client, ipc::encode_answer(request->number, ipc::Welcome{ipc::kProtocolVersion, "test", client}, 1),
                   std::move(descriptors));
    } else if (std::holds_alternative<ipc::GetContacts>(request->request)) {
      ipc::Contacts contacts = three_places();
      contacts.generation = generation;
      contacts.search_ns = search_ns;
      if (++asked; refuses)
        server_.send(client, ipc::encode_answer(request->number, ipc::Failed{"", 0, "cancelled"}, 0), {});
      else
        server_.send(client, ipc::encode_answer(request->number, contacts, 0), {});
    } else {
      server_.send(client, ipc::encode_answer(request->number, ipc::DocumentState{}, 0), {});
    }
  }

  std::atomic<std::uint64_t> generation{1};
  std::atomic<std::int64_t> search_ns{0};
  std::atomic<int> asked{0};
  std::atomic<bool> refuses{false};

 private:
  ipc::StatePage page_;
  ipc::Server server_;
  std::thread thread_;
};

TEST(ContactLinkTest, asks_once_a_state_and_after_a_long_search_only_when_told) {
  std::string name = (std::filesystem::temp_directory_path() / "prismesh-contact-XXXXXX").string();
  const std::filesystem::path folder = ::mkdtemp(name.data());
  {
    ContactServer server(folder / "model.sock");
    MonotonicClock real;
    link::ModelLink link(folder / "model.sock", std::nullopt, real, notices::Trace(nullptr));
    ContactLink contact(link);
    const auto turn_until = [&](const auto& done) {
      for (int tries = 0; tries < 30000 && !done(); ++tries, std::this_thread::sleep_for(std::chrono::milliseconds(1))) link.turn();
      return done();
    };
    ASSERT_TRUE(turn_until([&] { return link.connection.connected(); }));
    const auto answered = [&] { return turn_until([&] { return !contact.asking(); }); };
    contact.want(1);
    contact.want(1);
    ASSERT_TRUE(answered());
    ASSERT_NE(contact.contacts(), nullptr);
    EXPECT_EQ(contact.contacts()->regions.size(), 3u);
    contact.want(1);
    EXPECT_FALSE(contact.asking()) << "it is here";
    server.generation = 2;
    contact.want(2);
    EXPECT_TRUE(contact.asking());
    ASSERT_TRUE(answered());
    server.generation = 3;
    server.search_ns = kMaxOwnSearchNs + 1;
    contact.want(3);
    EXPECT_TRUE(contact.asking()) << "the last one took the server no time";
    ASSERT_TRUE(answered());
    EXPECT_EQ(server.asked, 3);
    contact.want(4);
    EXPECT_FALSE(contact.asking()) << "the last one took long";
    server.generation = 4;
    server.search_ns = 0;
    contact.want(4, true);
    ASSERT_TRUE(answered());
    EXPECT_EQ(contact.contacts()->generation, 4u);
    server.refuses = true;
    contact.want(5);
    ASSERT_TRUE(answered());
    EXPECT_EQ(contact.problem(), "stopped; look again to see it");
    EXPECT_EQ(contact.contacts()->generation, 4u) << "the ones before stay";
    contact.want(5);
    EXPECT_FALSE(contact.asking()) << "that state was refused";
    contact.want(6);
    EXPECT_FALSE(contact.asking()) << "a search that was stopped is one too many";
    EXPECT_EQ(server.asked, 5);
    contact.want(5, true);
    contact.forget();
    EXPECT_TRUE(turn_until([&] { return server.asked == 6; }));
    for (int turn = 0; turn < 50; ++turn) link.turn(), std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(contact.contacts(), nullptr) << "an answer to a question that was given up";
    EXPECT_TRUE(contact.problem().empty());
  }
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
}

class ContactPanel : public panels::GuiTest {
 protected:
  std::optional<std::size_t> lay_out() {
    std::optional<std::size_t> clicked;
    panels::PanelLayout layout{kContactPicture};
    layout.run_command = [this](const input::Command& command) { commands_.insert(command.number); };
    gui_->layout(kContactPicture, 0.016, [&] { in_dock(kContactPicture, [&] { clicked = contact_panel(facts_, layout); }); });
    for (const auto& action : layout.actions) action();
    return clicked;
  }
  std::optional<std::size_t> click(double x, double y) {
    gui_->feed(display::PointerMoved{x, y, {}});
    lay_out();
    gui_->feed(display::ButtonChanged{display::MouseButton::left, true, x, y, {}});
    lay_out();
    gui_->feed(display::ButtonChanged{display::MouseButton::left, false, x, y, {}});
    return lay_out();
  }
  ContactFacts facts_;
  std::set<std::uint8_t> commands_;
};

TEST_F(ContactPanel, a_row_gives_its_region_and_buttons_step) {
  const ipc::Contacts contacts = three_places();
  facts_.contacts = &contacts;
  facts_.length_unit = "mm";
  facts_.chosen = 1;
  lay_out();
  lay_out();
  std::set<std::size_t> clicked;
  for (double x = 25; x < 130; x += 30)
    for (double y = 20; y < 300; y += 5)
      if (const auto region = click(x, y)) clicked.insert(*region);
  EXPECT_EQ(clicked, (std::set<std::size_t>{0, 1, 2}));
  EXPECT_EQ(commands_.size(), 3u) << "back, on, look again";
}

TEST_F(ContactPanel, is_laid_out_without_an_answer_too) {
  facts_.asking = true;
  facts_.problem = "modeld: no \xff";
  lay_out();
  EXPECT_FALSE(lay_out());
}

}  // namespace
}  // namespace prismesh::kiosk::tools::contact

namespace prismesh::kiosk::tools::shaping {
namespace {

TEST(TouchWords, name_the_parts_and_how_deep) {
  ipc::SnapshotInfo info;
  info.length_unit = "mm";
  info.parts.resize(3);
  info.parts[0].id = 7, info.parts[0].name = "Roof";
  info.parts[1].id = 9, info.parts[1].name = "Rail";
  info.parts[2].id = 11;
  ipc::PreviewTouches touches;
  EXPECT_EQ(touch_words(touches, info), "");
  touches.parts = 2;
  touches.part_a = mesh::PartIndex(0u), touches.part_b = mesh::PartIndex(1u);
  touches.depth = 0.8;
  EXPECT_EQ(touch_words(touches, info), "2 parts touch: 7 Roof and 9 Rail, 0.8 mm deep");
  touches.parts = 3;
  EXPECT_EQ(touch_words(touches, info), "3 parts touch: the worst are 7 Roof and 9 Rail, 0.8 mm deep");
  touches.cross = true;
  touches.parts = 2;
  touches.part_b = mesh::PartIndex(2u);
  EXPECT_EQ(touch_words(touches, info), "2 parts cross: 7 Roof and part 11");
  touches.parts = 1;
  touches.part_b = touches.part_a;
  EXPECT_EQ(touch_words(touches, info), "1 part crosses itself: 7 Roof");
  touches.cross = false;
  EXPECT_EQ(touch_words(touches, info), "1 part touches itself: 7 Roof, 0.8 mm deep");
  touches.parts = 2;
  touches.part_b = mesh::PartIndex(77u);
  EXPECT_EQ(touch_words(touches, info), "2 parts touch: 7 Roof and shells without a part, 0.8 mm deep");
  touches.watched = false;
  EXPECT_EQ(touch_words(touches, info), "so many shells move that it isn't seen what they touch");
}

}  // namespace
}  // namespace prismesh::kiosk::tools::shaping
