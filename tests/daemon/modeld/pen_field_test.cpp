// The haptic pen's field as the pen's process gets it: from a daemon in this process, for a pen page that the test writes.
#include "daemon/modeld/pen_field.h"

#include <chrono>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <thread>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "daemon/modeld/daemon.h"
#include "daemon/modeld/document_keeper.h"
#include "ipc/model/client.h"
#include "tests/daemon/modeld/folder.h"

namespace prismesh::modeld {
namespace {

using namespace std::chrono_literals;
using mesh::Vec3;
using mesh::field::Placement;

constexpr auto kPenPatience = 60s;

/// A pen whose process is the test, and that process's view of the fields.
struct HandMadePen {
  ipc::PenPage page = ipc::PenPage::create().value();
  std::optional<ipc::HapticFieldPageReader> reader;
  std::unique_ptr<HapticField> field = std::make_unique<HapticField>();

  void move_to(const Vec3& place_mm, std::uint64_t has_generation = 0) {
    ipc::PenState state;
    state.time_ns = state.measured_ns = MonotonicClock().now_ns();
    state.position_mm = {place_mm.x(), place_mm.y(), place_mm.z()};
    state.field_generation = has_generation;
    page.set_state(state);
  }
  /// Reads a field that was published after all that was read of the page.
  bool wait_for_next() {
    const std::uint64_t newest = reader->newest();
    return wait_for([newest](const HapticField& each) { return each.number > newest + 1; });
  }
  /// Reads fields until one is as wished.
  bool wait_for(const std::function<bool(const HapticField&)>& is_wished) {
    const auto until = std::chrono::steady_clock::now() + kPenPatience;
    while (std::chrono::steady_clock::now() < until) {
      if (reader->read(*field) && is_wished(*field)) return true;
      std::this_thread::sleep_for(1ms);
    }
    ADD_FAILURE() << "the field didn't come";
    return false;
  }
};

bool has(const HapticBrick& brick, const Vec3& place_mm, double around_mm) {
  for (int axis = 0; axis < 3; ++axis) {
    const double end = brick.origin_mm[axis] + brick.spacing_mm * (brick.count[axis] - 1);
    if (place_mm[axis] - around_mm < brick.origin_mm[axis] || place_mm[axis] + around_mm > end) return false;
  }
  return true;
}

/// Compares each node near the place with the tree's closest point. Returns how many had a shell within their reach.
int expect_distances(const HapticBrick& brick, const mesh::spatial::BoxTree& tree, const Placement& placement, double reach_mm) {
  int near = 0, at = 0;
  for (int z = 0; z < brick.count[2]; ++z)
    for (int y = 0; y < brick.count[1]; ++y)
      for (int x = 0; x < brick.count[0]; ++x, ++at) {
        if ((x + y + z) % 7 != 0) continue;
        const Vec3 place_mm = Vec3(brick.origin_mm) + brick.spacing_mm * Vec3(x, y, z);
        const auto closest = tree.closest(placement.to_model(place_mm));
        const double distance_mm = closest ? (placement.to_pen(closest->point) - place_mm).norm() : std::numeric_limits<double>::infinity();
        EXPECT_NEAR(brick.distance_mm[at], std::min(distance_mm, reach_mm), 1e-4);
        if (distance_mm < reach_mm) ++near;
        if (testing::Test::HasFailure()) return near;
      }
  return near;
}

class PenFields : public ::testing::Test {
 protected:
  void SetUp() override {
    daemon_.emplace(Daemon::start({folder_.path() / "run", folder_.state()}).value());
    thread_ = std::thread([this] { daemon_->run(); });
    client_.emplace(connect());
  }
  void TearDown() override {
    client_.reset();
    daemon_->stop();
    thread_.join();
  }
  ipc::Client connect() { return ipc::Client::connect(ipc::model_socket_path(folder_.path() / "run"), "test").value(); }
  void open() {
    ipc::Open request;
    request.path = folder_.sheet().string();
    const auto opened = client_->call(request, kPenPatience);
    ASSERT_TRUE(opened) << opened.error().text();
  }
  /// The tree of the shells as every view sees them, and the place of a node.
  mesh::spatial::BoxTree tree() {
    const auto view = client_->snapshot().value();
    mesh::Model model;
    model.positions.resize(view->node_count(), Vec3::Zero());
    for (std::size_t n = 0; n < view->node_count(); ++n) model.positions.set(n, view->position(n));
    model.shell_nodes.resize(view->shell_count());
    for (std::size_t s = 0; s < view->shell_count(); ++s) model.shell_nodes.set(s, view->shell(s));
    return mesh::spatial::BoxTree(model);
  }
  Vec3 place_of(std::int64_t id) {
    const auto view = client_->snapshot().value();
    for (std::size_t n = 0; n < view->node_count(); ++n)
      if (view->node_id(n) == id) return view->position(n);
    ADD_FAILURE() << "no node " << id;
    return Vec3::Zero();
  }
  void follow(const ipc::FollowPen& request = {}) {
    const auto page = client_->follow_pen(request, pen_.page.descriptor());
    ASSERT_TRUE(page) << page.error().text();
    pen_.reader.emplace(ipc::HapticFieldPageReader::map(*page).value());
  }
  std::string refusal(const ipc::FollowPen& request, const ipc::Descriptor& descriptor) {
    const auto page = client_->follow_pen(request, descriptor);
    EXPECT_FALSE(page);
    return page ? "" : page.error().text();
  }
  void move_node_up(double distance) {
    mesh::document::Translate translate;
    translate.by = {0, 0, distance};
    translate.shaping.on = "1313";
    const auto edited = client_->call(ipc::ApplyEdit{translate}, kPenPatience);
    ASSERT_TRUE(edited) << edited.error().text();
  }

  test::Folder folder_;
  std::optional<Daemon> daemon_;
  std::thread thread_;
  std::optional<ipc::Client> client_;
  HandMadePen pen_;
};

const double kFineReach = mesh::field::fine_shape().reach_mm, kCoarseReach = mesh::field::coarse_shape().reach_mm;

TEST_F(PenFields, are_the_distances_about_the_pen) {
  open();
  const Placement placement{Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix(), Vec3(5, -60, 20), 0.8};
  const Eigen::Quaterniond turn(placement.turn);
  const Vec3 sheet_mm = placement.to_pen(place_of(1313));
  pen_.move_to(sheet_mm + Vec3(200, 0, 0));
  const std::int64_t before_ns = MonotonicClock().now_ns();
  follow({3, {turn.w(), turn.x(), turn.y(), turn.z()}, {5, -60, 20}, 0.8});
  ASSERT_TRUE(pen_.wait_for([](const HapticField&) { return true; }));
  EXPECT_EQ(pen_.field->placement, 3u);
  EXPECT_GE(pen_.field->time_ns, before_ns);
  EXPECT_NE(pen_.field->mesh_generation, 0u);
  EXPECT_EQ(pen_.field->before_generation, 0u) << "the first field";

  const std::uint64_t generation = pen_.field->mesh_generation;
  pen_.move_to(sheet_mm + Vec3(0.3, 0.4, 0.5));
  ASSERT_TRUE(pen_.wait_for([&](const HapticField& field) { return has(field.fine, sheet_mm, 9); }));
  EXPECT_EQ(pen_.field->mesh_generation, generation) << "only the pen has moved";
  EXPECT_EQ(pen_.field->before_generation, generation);
  EXPECT_EQ(pen_.field->moved_count, 0);
  const mesh::spatial::BoxTree tree = this->tree();
  EXPECT_GT(expect_distances(pen_.field->fine, tree, placement, kFineReach), 100);
  EXPECT_GT(expect_distances(pen_.field->coarse, tree, placement, kCoarseReach), 100);
}

TEST_F(PenFields, follow_an_edit) {
  open();
  const Vec3 sheet_mm = place_of(1313);
  pen_.move_to(sheet_mm);
  follow({1});
  ASSERT_TRUE(pen_.wait_for([](const HapticField&) { return true; }));
  const std::uint64_t before = pen_.field->mesh_generation;
  move_node_up(0.25);
  const auto edited = std::chrono::steady_clock::now();
  ASSERT_TRUE(pen_.wait_for([&](const HapticField& field) { return field.mesh_generation != before; }));
  const auto late = std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - edited);
  RecordProperty("us_after_the_answer", static_cast<int>(late.count()));
  std::printf("the field came %d us after the edit's answer\n", static_cast<int>(late.count()));
  EXPECT_GT(pen_.field->mesh_generation, before);
  EXPECT_EQ(pen_.field->before_generation, before);
  EXPECT_NEAR(pen_.field->max_moved_mm, 0.25, 1e-6);
  EXPECT_GT(pen_.field->moved_count, 0);
  EXPECT_GT(expect_distances(pen_.field->fine, tree(), Placement(), kFineReach), 100);

  // What moved is told since the generation that the pen's process has.
  const std::uint64_t middle = pen_.field->mesh_generation;
  pen_.move_to(sheet_mm, before);
  move_node_up(0.5);
  ASSERT_TRUE(pen_.wait_for([&](const HapticField& field) { return field.mesh_generation != middle; }));
  EXPECT_EQ(pen_.field->before_generation, before);
  EXPECT_NEAR(pen_.field->max_moved_mm, 0.75, 1e-6);

  // Another state with the same shells is no new one.
  const std::uint64_t last = pen_.field->mesh_generation, number = pen_.field->number;
  mesh::document::Select select;
  select.expr = "1001-1025";
  ASSERT_TRUE(client_->call(ipc::ApplyEdit{select}, kPenPatience));
  ASSERT_TRUE(pen_.wait_for([&](const HapticField& field) { return field.number > number + 2; }));
  EXPECT_EQ(pen_.field->mesh_generation, last);
}

TEST_F(PenFields, follow_a_drag_and_return_when_it_is_cancelled) {
  open();
  const Vec3 sheet_mm = place_of(1313);
  pen_.move_to(sheet_mm);
  follow({1});
  ASSERT_TRUE(pen_.wait_for([](const HapticField&) { return true; }));
  const std::uint64_t before = pen_.field->mesh_generation;
  EXPECT_EQ(pen_.reader->resistance().value().newton, 0);

  mesh::document::Move move;
  move.shaping.on = "1313";
  const auto begun = client_->call(ipc::BeginDrag{move}, kPenPatience);
  ASSERT_TRUE(begun) << begun.error().text();
  const std::uint64_t drag = std::get<ipc::DragBegun>(*begun).drag;
  ASSERT_TRUE(client_->send(ipc::DragStep{drag, 1, {0, 0, 0.25}, 0, 0}));
  ASSERT_TRUE(pen_.wait_for([&](const HapticField& field) { return field.mesh_generation != before; }));
  EXPECT_EQ(pen_.field->before_generation, before);
  EXPECT_NEAR(pen_.field->max_moved_mm, 0.25, 1e-6);
  EXPECT_EQ(pen_.reader->resistance().value().newton, 0) << "nothing has become bad";

  // Far off its place the shells about the node are bad; on the way they resist. The model is still as it was.
  ASSERT_TRUE(client_->send(ipc::DragStep{drag, 2, {0, 0, 9}, 0, 0}));
  const auto resists = [this](const HapticField&) { return pen_.reader->resistance().value().newton > 0; };
  ASSERT_TRUE(pen_.wait_for(resists));
  ASSERT_TRUE(pen_.wait_for_next());
  const HapticResistance resistance = pen_.reader->resistance().value();
  EXPECT_EQ(resistance.placement, 1u);
  EXPECT_LE(resistance.newton, 2);
  EXPECT_GT(Vec3(resistance.direction).z(), 0.5);
  EXPECT_EQ(place_of(1313), sheet_mm);

  const std::uint64_t dragged = pen_.field->mesh_generation;
  ASSERT_TRUE(client_->call(ipc::CancelDrag{drag}, kPenPatience));
  ASSERT_TRUE(pen_.wait_for([&](const HapticField& field) { return field.mesh_generation > dragged; }));
  EXPECT_EQ(pen_.reader->resistance().value().newton, 0);
  EXPECT_GT(expect_distances(pen_.field->fine, tree(), Placement(), kFineReach), 100);
}

TEST_F(PenFields, are_those_of_the_edit_when_a_drag_is_committed) {
  open();
  pen_.move_to(place_of(1313));
  follow({1});
  ASSERT_TRUE(pen_.wait_for([](const HapticField&) { return true; }));
  mesh::document::Move move;
  move.shaping.on = "1313";
  const auto begun = client_->call(ipc::BeginDrag{move}, kPenPatience);
  ASSERT_TRUE(begun) << begun.error().text();
  const std::uint64_t drag = std::get<ipc::DragBegun>(*begun).drag;
  ASSERT_TRUE(client_->send(ipc::DragStep{drag, 1, {0, 0, 9}, 0, 0}));
  ASSERT_TRUE(pen_.wait_for([this](const HapticField&) { return pen_.reader->resistance().value().newton > 0; }));
  ASSERT_TRUE(pen_.wait_for_next());
  const std::uint64_t dragged = pen_.field->mesh_generation;
  ASSERT_TRUE(client_->call(ipc::CommitDrag{drag}, kPenPatience));
  ASSERT_TRUE(pen_.wait_for([this](const HapticField&) { return pen_.reader->resistance().value().newton == 0; }));
  ASSERT_TRUE(pen_.wait_for_next());
  EXPECT_EQ(pen_.field->mesh_generation, dragged) << "the edit is what was felt, bit for bit";
  EXPECT_GT(expect_distances(pen_.field->fine, tree(), Placement(), kFineReach), 100);
}

TEST_F(PenFields, leave_hidden_parts_out) {
  open();
  const Vec3 sheet_mm = place_of(1313);
  pen_.move_to(sheet_mm);
  follow({1});
  ASSERT_TRUE(pen_.wait_for([](const HapticField&) { return true; }));
  const std::uint64_t whole = pen_.field->mesh_generation;
  EXPECT_GT(expect_distances(pen_.field->fine, tree(), Placement(), kFineReach), 100);
  EXPECT_GT(pen_.reader->guides().value().count, 0);
  const auto apply = [this](const mesh::document::Edit& edit) { ASSERT_TRUE(client_->call(ipc::ApplyEdit{edit}, kPenPatience)); };

  mesh::document::SetParts hide;
  hide.on = "part:7";
  hide.action = mesh::document::VisibilityAction::hide;
  apply(hide);
  ASSERT_TRUE(pen_.wait_for([&](const HapticField& field) { return field.mesh_generation != whole; }));
  const std::uint64_t hidden = pen_.field->mesh_generation;
  EXPECT_EQ(expect_distances(pen_.field->fine, {}, Placement(), kFineReach), 0);
  EXPECT_EQ(pen_.reader->guides().value().count, 0);

  move_node_up(0.25);  // nobody feels that
  const std::uint64_t number = pen_.field->number;
  ASSERT_TRUE(pen_.wait_for([&](const HapticField& field) { return field.number > number + 2; }));
  EXPECT_EQ(pen_.field->mesh_generation, hidden);

  apply(mesh::document::Undo{});
  apply(mesh::document::Undo{});
  ASSERT_TRUE(pen_.wait_for([&](const HapticField& field) { return field.mesh_generation != hidden; }));
  EXPECT_GT(expect_distances(pen_.field->fine, tree(), Placement(), kFineReach), 100);
}

TEST_F(PenFields, come_with_the_guides_near_the_pen) {
  open();
  const Placement twice{Eigen::Matrix3d::Identity(), Vec3(0, 0, 2), 2};
  const Vec3 node_mm = twice.to_pen(place_of(1313));
  pen_.move_to(node_mm + Vec3(0.5, 0.5, 0));
  follow({4, {1, 0, 0, 0}, {0, 0, 2}, 2});
  ASSERT_TRUE(pen_.wait_for([&](const HapticField& field) { return has(field.fine, node_mm, 9); }));
  const HapticGuides guides = pen_.reader->guides().value();
  EXPECT_EQ(guides.placement, 4u);
  EXPECT_GE(guides.time_ns, pen_.field->time_ns);
  ASSERT_GT(guides.count, 0);
  EXPECT_LT((Vec3(guides.guides[0].from_mm) - node_mm).norm(), 1e-9);
  EXPECT_LT((Vec3(guides.guides[0].to_mm) - node_mm).norm(), 1e-9);
}

TEST_F(PenFields, are_empty_without_a_document) {
  pen_.move_to(Vec3(1, 2, 3));
  follow({1});
  ASSERT_TRUE(pen_.wait_for([](const HapticField&) { return true; }));
  EXPECT_EQ(expect_distances(pen_.field->fine, {}, Placement(), kFineReach), 0);
  const std::uint64_t none = pen_.field->mesh_generation;
  open();
  pen_.move_to(place_of(1313));
  ASSERT_TRUE(pen_.wait_for([&](const HapticField& field) { return field.mesh_generation != none && has(field.fine, place_of(1313), 9); }));
  EXPECT_GT(expect_distances(pen_.field->fine, tree(), Placement(), kFineReach), 100);
  const std::uint64_t opened = pen_.field->mesh_generation;
  ASSERT_TRUE(client_->call(ipc::Close{}, kPenPatience));
  ASSERT_TRUE(pen_.wait_for([&](const HapticField& field) { return field.mesh_generation != opened; }));
  EXPECT_EQ(pen_.field->before_generation, 0u);
  EXPECT_EQ(expect_distances(pen_.field->fine, {}, Placement(), kFineReach), 0);
  EXPECT_EQ(pen_.field->fine.nearest[0], -1);
}

TEST_F(PenFields, have_the_newest_placement_until_the_pen_is_left) {
  open();
  pen_.move_to(place_of(1313));
  follow({1});
  ASSERT_TRUE(pen_.wait_for([](const HapticField& field) { return field.placement == 1; }));
  const Placement twice{Eigen::Matrix3d::Identity(), Vec3(0, 0, 2), 2};
  const Vec3 sheet_mm = twice.to_pen(place_of(1313));
  pen_.move_to(sheet_mm);
  follow({2, {1, 0, 0, 0}, {0, 0, 2}, 2});
  ASSERT_TRUE(pen_.wait_for([&](const HapticField& field) { return field.placement == 2 && has(field.fine, sheet_mm, 9); }));
  EXPECT_GT(expect_distances(pen_.field->fine, tree(), twice, kFineReach), 100);

  ipc::Client other = connect();
  EXPECT_FALSE(other.call(ipc::LeavePen{})) << "it isn't the other client's";
  ASSERT_TRUE(client_->call(ipc::LeavePen{}));
  const std::uint64_t last = pen_.reader->newest();
  pen_.move_to(sheet_mm + Vec3(5, 0, 0));
  move_node_up(0.25);
  std::this_thread::sleep_for(100ms);
  EXPECT_EQ(pen_.reader->newest(), last);
  EXPECT_FALSE(client_->call(ipc::LeavePen{}));

  follow({3});
  ASSERT_TRUE(pen_.wait_for([](const HapticField& field) { return field.placement == 3; }));
}

TEST_F(PenFields, are_asked_for_without_waiting) {
  const auto ask = [&](std::uint64_t placement) {
    const auto number = client_->send_follow_pen({placement}, pen_.page.descriptor());
    ASSERT_TRUE(number) << number.error().text();
    const auto until = std::chrono::steady_clock::now() + kPenPatience;
    std::optional<ipc::Client::Reply> reply;
    while (!reply && std::chrono::steady_clock::now() < until) {
      ASSERT_TRUE(client_->poll(10ms));
      reply = client_->next_reply();
    }
    ASSERT_TRUE(reply);
    EXPECT_EQ(reply->request, *number);
    EXPECT_TRUE(std::holds_alternative<ipc::PenFollowed>(reply->answer));
  };
  EXPECT_FALSE(client_->take_pen_field()) << "none was asked for";
  ask(1);
  const ipc::Descriptor first = client_->take_pen_field().value();
  EXPECT_FALSE(client_->take_pen_field()) << "it was taken";
  ask(2);
  ask(3);
  const ipc::Descriptor third = client_->take_pen_field().value();
  EXPECT_TRUE(third.same_file(first)) << "the page stays while a pen is followed";
  EXPECT_FALSE(client_->take_pen_field()) << "the second one wasn't kept";
  ASSERT_TRUE(client_->call(ipc::LeavePen{}));
  ask(4);
  EXPECT_FALSE(client_->take_pen_field().value().same_file(first));
  EXPECT_FALSE(first.same_file(ipc::Descriptor()));
}

TEST_F(PenFields, end_with_the_client) {
  ipc::Client broker = connect();
  pen_.move_to(Vec3::Zero());
  pen_.reader.emplace(ipc::HapticFieldPageReader::map(broker.follow_pen({1}, pen_.page.descriptor()).value()).value());
  ASSERT_TRUE(pen_.wait_for([](const HapticField&) { return true; }));
  { const ipc::Client gone = std::move(broker); }
  const auto until = std::chrono::steady_clock::now() + kPenPatience;
  std::uint64_t last = 0;
  do {
    last = pen_.reader->newest();
    std::this_thread::sleep_for(200ms);  // five renewals
  } while (pen_.reader->newest() != last && std::chrono::steady_clock::now() < until);
  EXPECT_EQ(pen_.reader->newest(), last);
}

TEST_F(PenFields, refuse_what_cant_be_followed) {
  const ipc::HapticFieldPage other = ipc::HapticFieldPage::create().value();
  EXPECT_NE(refusal({1}, other.descriptor()).find("prismesh-pen: it has another size"), std::string::npos);
  ipc::FollowPen request;
  for (const double scale : {0.0, -1.0, 1e300}) {
    request.scale = scale;
    EXPECT_NE(refusal(request, pen_.page.descriptor()).find("\"scale\" must be above 0"), std::string::npos) << scale;
  }
  request = {};
  request.turn = {1, 1, 0, 0};
  EXPECT_NE(refusal(request, pen_.page.descriptor()).find("unit quaternion"), std::string::npos);
  request = {};
  request.shift_mm = {0, 1e7, 0};
  EXPECT_NE(refusal(request, pen_.page.descriptor()).find("\"shift_mm\""), std::string::npos);
  const auto without = client_->call(ipc::FollowPen{}, kPenPatience);
  ASSERT_FALSE(without);
  EXPECT_NE(without.error().text().find("descriptor"), std::string::npos);
  request = {};
  request.scale = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(placement_of(request));
  request.scale = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(placement_of(request));
  follow();  // the connection is as it was
}

TEST(PenField, computes_nothing_for_a_pen_that_rests) {
  const test::Folder folder;
  DocumentKeeper keeper(StateFolder(folder.state()), std::size_t{1} << 30);
  ipc::Open request;
  request.path = folder.sheet().string();
  ASSERT_TRUE(keeper.open(request, {}));
  PenField field;
  field.show(std::make_shared<const mesh::document::Document>(keeper.document()));
  HandMadePen pen;
  const auto followed = field.follow(ipc::PenPageReader::map(pen.page.descriptor()).value(), {}, 1);
  ASSERT_TRUE(followed);
  pen.reader.emplace(ipc::HapticFieldPageReader::map(*followed).value());
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(pen.reader->newest(), 0u) << "the pen has no pose yet";

  pen.move_to(Vec3(10, 10, 0));
  ASSERT_TRUE(pen.wait_for([](const HapticField&) { return true; }));
  const std::int64_t first_ns = pen.field->time_ns;
  const auto first = std::make_unique<HapticField>(*pen.field);
  ASSERT_TRUE(pen.wait_for([](const HapticField& each) { return each.number >= 4; })) << "it is renewed, so that it doesn't fade";
  EXPECT_GT(pen.field->time_ns, first_ns);
  EXPECT_EQ(pen.field->mesh_generation, first->mesh_generation);
  EXPECT_EQ(pen.field->fine.distance_mm[0], first->fine.distance_mm[0]);
  pen.move_to(Vec3(10.2, 10, 0));
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(field.computed(), 1u) << "less than half a voxel";
  pen.move_to(Vec3(10.5, 10, 0));
  const auto until = std::chrono::steady_clock::now() + kPenPatience;
  while (field.computed() < 2 && std::chrono::steady_clock::now() < until) std::this_thread::sleep_for(1ms);
  pen.move_to(Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(field.computed(), 2u) << "that is no pose";
}

}  // namespace
}  // namespace prismesh::modeld
