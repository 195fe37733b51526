#include <array>
#include <cerrno>
#include <map>
#include <random>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>

#include "ipc/model/snapshot_publisher.h"
#include "ipc/model/snapshot_table.h"
#include "mesh/model/adjacency.h"
#include "mesh/model/topology_change.h"
#include "mesh/quality/triangle_clusters.h"
#include "tests/ipc/model/small_document.h"

namespace prismesh::ipc {
namespace {

using test::grid_document;
using test::move_node;

/// What a client does with a published snapshot: maps the segments it does not have yet, then the table.
class Reader {
 public:
  explicit Reader(SnapshotPublisher& publisher) : publisher_(publisher) {}

  std::shared_ptr<const SnapshotView> map(const PublishedSnapshot& snapshot) {
    std::vector<std::shared_ptr<const Mapping>> segments;
    for (const std::uint64_t id : snapshot.segments) {
      if (!known_.contains(id)) {
        const Result<Descriptor> descriptor = publisher_.segment(id);
        known_[id] = std::make_shared<const Mapping>(std::move(Mapping::map(*descriptor, false).value()));
      }
      segments.push_back(known_[id]);
    }
    Result<std::shared_ptr<const SnapshotView>> view = SnapshotView::map(snapshot.table, segments);
    if (!view) ADD_FAILURE() << view.error().text();
    return view.value_or(nullptr);
  }

 private:
  SnapshotPublisher& publisher_;
  std::map<std::uint64_t, std::shared_ptr<const Mapping>> known_;
};

TEST(Snapshot, holds_what_the_picture_needs) {
  mesh::document::Document document = grid_document(100, 90);
  SnapshotPublisher publisher;
  Reader reader(publisher);
  const auto view = reader.map(publisher.publish(document, true).value());
  ASSERT_TRUE(view);
  EXPECT_EQ(view->node_count(), 101u * 91);
  EXPECT_EQ(view->shell_count(), 9000u);
  EXPECT_EQ(view->position(9000), document.current().model.positions[9000]);
  EXPECT_EQ(view->info().nodes, 101u * 91);
  EXPECT_EQ(view->node_id(9000), 9001);
  EXPECT_EQ(view->shell(8999), document.current().model.shell_nodes[8999]);
  EXPECT_EQ(view->shell_part(8999).value, 0u);
  EXPECT_EQ(view->info().parts.at(0).name, "panel");
  EXPECT_EQ(view->info().parts.at(0).shells, 9000u);
  EXPECT_TRUE(view->info().changed);
}

TEST(Snapshot, says_what_is_selected_hidden_and_locked) {
  mesh::document::Document document = grid_document(4, 4);
  auto next = std::make_shared<mesh::document::Generation>(document.current());
  next->selected_nodes = 3;
  next->selected_shells = 2;
  next->parts =
      std::make_shared<const std::vector<mesh::document::PartState>>(1, mesh::document::PartState{.hidden = false, .locked = true});
  document.generations.push_back(next);
  document.cursor = 1;
  SnapshotPublisher publisher;
  Reader reader(publisher);
  const auto locked = reader.map(publisher.publish(document, false).value());
  EXPECT_EQ(locked->info().selected_nodes, 3u);
  EXPECT_EQ(locked->info().selected_shells, 2u);
  EXPECT_TRUE(locked->info().parts.at(0).locked);
  EXPECT_FALSE(locked->info().parts.at(0).hidden);
  EXPECT_TRUE(locked->info().can_undo);
  EXPECT_FALSE(locked->info().can_redo);
}

TEST(Snapshot, says_what_criteria_the_deck_and_its_parts_have) {
  mesh::document::Document document = grid_document(4, 4);
  SnapshotPublisher publisher;
  Reader reader(publisher);
  const auto usual = reader.map(publisher.publish(document, false).value());
  EXPECT_EQ(usual->info().criteria, "default") << "nobody chose";
  EXPECT_EQ(usual->info().parts.at(0).criteria, "");
  auto judging = std::make_shared<mesh::document::Judging>();
  const auto same = std::make_shared<const mesh::quality::Criteria>(mesh::quality::default_criteria());
  judging->criteria = {"/decks/ours.toml", same, std::make_shared<const std::string>()};
  judging->parts.resize(1);
  judging->guessed.resize(1);
  judging->parts[0].criteria = mesh::document::ChosenCriteria{"strict", same, std::make_shared<const std::string>()};
  settle(*judging);
  auto next = std::make_shared<mesh::document::Generation>(document.current());
  next->judging = judging;
  next->number = document.next_number++;
  document.generations.push_back(next);
  document.cursor = 1;
  const auto chosen = reader.map(publisher.publish(document, false).value());
  EXPECT_EQ(chosen->info().criteria, "/decks/ours.toml");
  EXPECT_EQ(chosen->info().parts.at(0).criteria, "strict");
}

TEST(Snapshot, counts_the_nodes_that_are_there) {
  mesh::document::Document document = grid_document(4, 4);
  auto next = std::make_shared<mesh::document::Generation>(document.current());
  std::vector<std::int64_t> ids;
  for (std::size_t n = 0; n < next->model.node_count(); ++n) ids.push_back(next->model.node_ids[n]);
  next->model.node_index = std::make_shared<const mesh::IdIndex>(ids);
  mesh::remove_node(next->model, mesh::NodeIndex(7));
  next->number = document.next_number++;
  document.generations.push_back(std::move(next));
  document.cursor = 1;
  SnapshotPublisher publisher;
  Reader reader(publisher);
  const auto view = reader.map(publisher.publish(document, true).value());
  ASSERT_TRUE(view);
  EXPECT_EQ(view->info().nodes, 24u);
  EXPECT_EQ(view->node_count(), 25u) << "indices stay";
}

TEST(Snapshot, says_whether_there_are_unsaved_edits_though_the_state_is_the_same) {
  const mesh::document::Document document = grid_document(4, 4);
  SnapshotPublisher publisher;
  Reader reader(publisher);
  EXPECT_TRUE(reader.map(publisher.publish(document, true).value())->info().changed);
  EXPECT_FALSE(reader.map(publisher.publish(document, false).value())->info().changed) << "it was saved";
}

TEST(Snapshot, counts_the_shells_of_each_part_anew_when_parts_or_shells_change) {
  mesh::document::Document document = grid_document(4, 4);
  SnapshotPublisher publisher;
  Reader reader(publisher);
  const auto shells = [&] {
    std::vector<std::uint64_t> counts;
    const auto view = reader.map(publisher.publish(document, true).value());
    for (const SnapshotPart& part : view->info().parts) counts.push_back(part.shells);
    return counts;
  };
  const auto push = [&](auto change) {
    auto next = std::make_shared<mesh::document::Generation>(document.current());
    change(*next);
    next->number = document.next_number++;
    document.generations.push_back(std::move(next));
    document.cursor = document.generations.size() - 1;
  };
  EXPECT_EQ(shells(), (std::vector<std::uint64_t>{16}));
  push([](mesh::document::Generation& next) {
    std::vector<mesh::Part> parts = *next.model.parts;
    parts.push_back(parts.front());
    next.model.parts = std::make_shared<const std::vector<mesh::Part>>(parts);
    next.parts = std::make_shared<const std::vector<mesh::document::PartState>>(2);
  });
  EXPECT_EQ(shells(), (std::vector<std::uint64_t>{16, 0}));
  push([](mesh::document::Generation& next) { next.model.shell_parts.set(3, mesh::PartIndex(1)); });
  EXPECT_EQ(shells(), (std::vector<std::uint64_t>{15, 1}));
  push([](mesh::document::Generation& next) {
    std::vector<std::int64_t> ids;
    for (std::size_t shell = 0; shell < next.model.shell_count(); ++shell) ids.push_back(next.model.shell_ids[shell]);
    next.model.shell_index = std::make_shared<const mesh::IdIndex>(ids);
    mesh::remove_shell(next.model, mesh::ShellIndex(3));
  });
  EXPECT_EQ(shells(), (std::vector<std::uint64_t>{15, 0}));
}

TEST(Snapshot, memory_that_could_shrink_under_its_reader_is_refused) {
  for (const int seals : {0, F_SEAL_GROW, F_SEAL_SHRINK}) {
    const Descriptor memory(::memfd_create("test", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    ASSERT_EQ(::ftruncate(memory.get(), 4096), 0);
    ASSERT_EQ(::fcntl(memory.get(), F_ADD_SEALS, seals), 0);
    const Result<Mapping> mapping = Mapping::map(memory, false);
    EXPECT_EQ(mapping.has_value(), seals == F_SEAL_SHRINK) << seals;
  }
  const Descriptor file(::open("/tmp", O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
  ASSERT_EQ(::ftruncate(file.get(), 4096), 0);
  EXPECT_FALSE(Mapping::map(file, false)) << "a file can't be sealed at all";
}

TEST(Snapshot, copies_only_the_chunks_that_changed) {
  mesh::document::Document document = grid_document(300, 300);
  SnapshotPublisher publisher;
  Reader reader(publisher);
  const PublishedSnapshot first = publisher.publish(document, false).value();
  const auto before = reader.map(first);
  const std::size_t copied = publisher.bytes_copied();
  move_node(document, 5000, {1, 2, 3});
  const auto after = reader.map(publisher.publish(document, true).value());

  EXPECT_EQ(publisher.bytes_copied() - copied, mesh::kChunkSize * sizeof(mesh::Vec3));
  EXPECT_EQ(after->position(5000), mesh::Vec3(1, 2, 3));
  EXPECT_NE(before->position(5000), mesh::Vec3(1, 2, 3)) << "a leased snapshot changed under its reader";
  for (std::size_t c = 0; c < after->chunk_count(SnapshotArray::positions); ++c)
    EXPECT_EQ(after->chunk_version(SnapshotArray::positions, c) == before->chunk_version(SnapshotArray::positions, c),
              c != 5000 / mesh::kChunkSize);
  EXPECT_EQ(after->chunk_version(SnapshotArray::shell_nodes, 3), before->chunk_version(SnapshotArray::shell_nodes, 3));
}

TEST(Snapshot, says_of_each_shell_by_what_edits_made_it_worse_and_copies_only_that) {
  using mesh::quality::ShellState;
  mesh::document::Document document = grid_document(300, 300);
  auto opened = std::make_shared<mesh::document::Generation>(document.current());
  opened->quality.set(7, ShellState{1, 1});
  document.generations = {opened};
  document.opened = opened;
  SnapshotPublisher publisher;
  Reader reader(publisher);
  const PublishedSnapshot first = publisher.publish(document, false).value();
  const auto before = reader.map(first);
  EXPECT_EQ(before->shell_damage(7), ShellState{}) << "it was so when the deck was opened";

  auto next = std::make_shared<mesh::document::Generation>(*opened);
  next->quality.set(7, ShellState{5, 1});
  next->quality.set(60000, ShellState{2, 2});
  next->number = 2;
  document.generations.push_back(next);
  document.cursor = 1;
  const std::size_t copied = publisher.bytes_copied();
  const auto after = reader.map(publisher.publish(document, true).value());
  EXPECT_EQ(after->shell_damage(7), (ShellState{4, 0}));
  EXPECT_EQ(after->shell_damage(60000), (ShellState{2, 2}));
  EXPECT_EQ(after->shell_damage(60001), ShellState{});
  EXPECT_EQ(publisher.bytes_copied() - copied, 2 * 2 * mesh::kChunkSize * sizeof(ShellState)) << "two chunks of quality, two of damage";

  document.cursor = 0;
  const auto undone = reader.map(publisher.publish(document, false).value());
  EXPECT_EQ(undone->shell_damage(60000), ShellState{});
}

TEST(Snapshot, has_the_clusters_of_triangles_and_which_of_them_edits_made_worse) {
  using mesh::ShellIndex;
  mesh::document::Document document = grid_document(4, 4);
  const auto with = [](mesh::document::Generation generation, std::size_t first_quad, std::size_t quads) {
    for (std::size_t s = first_quad; s < first_quad + quads; ++s) {
      mesh::ShellNodes nodes = generation.model.shell_nodes[s];
      nodes.node[3] = nodes.node[2];
      generation.model.shell_nodes.set(s, nodes);
    }
    generation.model.adjacency = std::make_shared<const mesh::Adjacency>(mesh::build_adjacency(generation.model));
    generation.clusters =
        std::make_shared<const mesh::quality::TriangleClusters>(mesh::quality::find_triangle_clusters(generation.model, 1.0));
    return std::make_shared<const mesh::document::Generation>(std::move(generation));
  };
  document.opened = with(document.current(), 0, 2);  // they share node 1
  document.generations = {document.opened, with(*document.opened, 2, 1)};
  SnapshotPublisher publisher;
  Reader reader(publisher);
  const auto clusters_at = [&](std::size_t cursor) {
    document.cursor = cursor;
    const auto view = reader.map(publisher.publish(document, false).value());
    std::vector<SnapshotCluster> clusters;
    for (std::size_t i = 0; i < view->size(SnapshotArray::clusters); ++i)
      clusters.push_back(view->at<SnapshotCluster>(SnapshotArray::clusters, i));
    return clusters;
  };
  EXPECT_EQ(clusters_at(0), (std::vector<SnapshotCluster>{{ShellIndex(0), 2, 1, 0}})) << "node 1: corner 1 of shell 0, corner 0 of shell 1";
  EXPECT_EQ(clusters_at(1), (std::vector<SnapshotCluster>{{ShellIndex(0), 2, 1, 0}, {ShellIndex(1), 2, 1, 1}}));
  EXPECT_EQ(clusters_at(0).size(), 1u);
}

TEST(Snapshot, a_chunk_of_which_more_is_used_is_copied_again) {
  mesh::document::Document document = grid_document(4, 4);
  const auto whole = document.generations.front();
  const auto fewer = std::make_shared<mesh::document::Generation>(*whole);
  // They share their chunks, of which this one uses less.
  fewer->model.shell_nodes.resize(10);
  fewer->model.shell_ids.resize(10);
  fewer->model.shell_parts.resize(10);
  fewer->shell_marks.resize(10);
  fewer->quality.resize(10);
  ASSERT_EQ(fewer->model.shell_ids.chunk_owner(0), whole->model.shell_ids.chunk_owner(0));
  document.generations = {fewer, whole};
  document.opened = fewer;
  SnapshotPublisher publisher;
  Reader reader(publisher);
  const auto first = reader.map(publisher.publish(document, false).value());
  ASSERT_EQ(first->shell_count(), 10u);
  document.cursor = 1;
  const auto second = reader.map(publisher.publish(document, false).value());
  ASSERT_EQ(second->shell_count(), 16u);
  for (std::size_t s = 0; s < 16; ++s) {
    EXPECT_EQ(second->shell_id(s), static_cast<std::int64_t>(s + 1));
    EXPECT_EQ(second->shell(s), whole->model.shell_nodes[s]);
  }
}

TEST(Snapshot, publishing_the_same_again_copies_nothing) {
  mesh::document::Document document = grid_document(100, 100);
  SnapshotPublisher publisher;
  const PublishedSnapshot first = publisher.publish(document, false).value();
  const std::size_t copied = publisher.bytes_copied();
  const PublishedSnapshot second = publisher.publish(document, false).value();
  EXPECT_EQ(publisher.bytes_copied(), copied);
  EXPECT_NE(first.lease, second.lease);
}

TEST(Snapshot, returned_memory_is_used_again) {
  mesh::document::Document document = grid_document(200, 200);
  SnapshotPublisher publisher;
  std::uint64_t lease = publisher.publish(document, false)->lease;
  std::size_t held = 0;
  for (int i = 0; i < 500; ++i) {
    move_node(document, static_cast<std::size_t>(i * 37 % 40000), {1.0 * i, 0, 1});
    document.generations.erase(document.generations.begin(), document.generations.end() - 1);
    document.cursor = 0;
    const std::uint64_t next = publisher.publish(document, true)->lease;
    publisher.release(lease);
    lease = next;
    if (i == 10) held = publisher.bytes_held();
  }
  EXPECT_EQ(publisher.bytes_held(), held);
}

TEST(Snapshot, leased_memory_is_not_used_again) {
  mesh::document::Document document = grid_document(200, 200);
  SnapshotPublisher publisher;
  Reader reader(publisher);
  std::vector<std::shared_ptr<const SnapshotView>> views;
  for (int i = 0; i < 40; ++i) {
    move_node(document, 17, {1.0 * i, 0, 1});
    views.push_back(reader.map(publisher.publish(document, true).value()));
  }
  for (int i = 0; i < 40; ++i) EXPECT_EQ(views[static_cast<std::size_t>(i)]->position(17).x(), i);
}

TEST(Snapshot, closing_gives_the_memory_back) {
  mesh::document::Document document = grid_document(100, 100);
  SnapshotPublisher publisher;
  const std::uint64_t lease = publisher.publish(document, false)->lease;
  publisher.forget();
  EXPECT_GT(publisher.bytes_held(), 0u) << "a view still holds the lease";
  publisher.release(lease);
  EXPECT_EQ(publisher.bytes_held(), 0u);
}

TEST(Snapshot, versions_of_two_starts_differ) {
  mesh::document::Document document = grid_document(10, 10);
  SnapshotPublisher one(1);
  SnapshotPublisher two(1'000'000);
  Reader reader_one(one);
  Reader reader_two(two);
  EXPECT_NE(reader_one.map(one.publish(document, false).value())->chunk_version(SnapshotArray::positions, 0),
            reader_two.map(two.publish(document, false).value())->chunk_version(SnapshotArray::positions, 0));
}

TEST(Snapshot, a_reader_cannot_write) {
  mesh::document::Document document = grid_document(10, 10);
  SnapshotPublisher publisher;
  const PublishedSnapshot snapshot = publisher.publish(document, false).value();
  const Descriptor segment = publisher.segment(snapshot.segments.at(0)).value();
  EXPECT_FALSE(Mapping::map(segment, true));
  EXPECT_EQ(::pwrite(segment.get(), "x", 1, 0), -1);
  EXPECT_EQ(::ftruncate(segment.get(), 0), -1);
  EXPECT_FALSE(Mapping::map(snapshot.table, true));
}

TEST(Snapshot, draws_beams_and_the_outline_of_solids) {
  mesh::document::Document document = grid_document(9, 9);
  auto generation = std::make_shared<mesh::document::Generation>(document.current());
  auto beams = std::make_shared<mesh::ElementBlock>();
  beams->id = {1};
  beams->part = {mesh::PartIndex(0)};
  beams->first_node = {0, 3};
  beams->nodes = {mesh::NodeIndex(80), mesh::NodeIndex(70), mesh::NodeIndex(3)};
  // Two bricks side by side share the face 1-3-7-5; a collapsed brick is a tetrahedron apart from them.
  auto solids = std::make_shared<mesh::ElementBlock>();
  const auto add = [&](std::initializer_list<std::size_t> nodes) {
    solids->id.push_back(static_cast<std::int64_t>(solids->id.size() + 1));
    solids->part.push_back(mesh::PartIndex(0));
    for (const std::size_t node : nodes) solids->nodes.push_back(mesh::NodeIndex(node));
    solids->first_node.push_back(static_cast<std::uint32_t>(solids->nodes.size()));
  };
  add({0, 1, 3, 2, 4, 5, 7, 6});
  add({1, 8, 9, 3, 5, 10, 11, 7});
  add({20, 21, 22, 23, 23, 23, 23, 23});
  generation->model.elements[static_cast<std::size_t>(mesh::ElementClass::beam)] = beams;
  generation->model.elements[static_cast<std::size_t>(mesh::ElementClass::solid)] = solids;
  document.generations = {generation};
  SnapshotPublisher publisher;
  Reader reader(publisher);
  const auto view = reader.map(publisher.publish(document, false).value());
  // 1 beam, 6 edges of the tetrahedron, 20 edges of two bricks together.
  EXPECT_EQ(view->size(SnapshotArray::line_parts), 1u + 6 + 20);
  EXPECT_EQ(view->size(SnapshotArray::line_nodes), 2 * (1u + 6 + 20));
}

TEST(Snapshot, draws_welds_that_an_edit_adds_and_lists_their_part) {
  mesh::document::Document document = grid_document(9, 9);
  SnapshotPublisher publisher;
  Reader reader(publisher);
  const auto before = reader.map(publisher.publish(document, false).value());
  EXPECT_EQ(before->size(SnapshotArray::line_parts), 0u);
  const std::size_t parts = before->info().parts.size();

  auto next = std::make_shared<mesh::document::Generation>(document.current());
  mesh::Part part;
  part.id = 90;
  const mesh::PartIndex welds = mesh::add_part(next->model, part, {"*PART\n"});
  next->parts = std::make_shared<const std::vector<mesh::document::PartState>>(parts + 1);
  const std::array<mesh::NodeIndex, 2> ends{mesh::NodeIndex(0), mesh::NodeIndex(50)};
  mesh::add_element(next->model, mesh::ElementClass::beam, 1, welds, ends, mesh::kNoExample);
  document.generations.push_back(next);
  document.cursor = 1;
  const auto after = reader.map(publisher.publish(document, false).value());
  EXPECT_EQ(after->size(SnapshotArray::line_parts), 1u);
  ASSERT_EQ(after->info().parts.size(), parts + 1);
  EXPECT_EQ(after->info().parts.back().id, 90);

  document.cursor = 0;
  EXPECT_EQ(reader.map(publisher.publish(document, false).value())->size(SnapshotArray::line_parts), 0u);
}

SnapshotTable sound_table() {
  SnapshotTable table;
  table.arrays[0].count = table.arrays[1].count = table.arrays[2].count = 5;
  for (std::size_t i = 0; i < 3; ++i) table.arrays[i].pieces.push_back({0, 64 * i * 2, i});
  table.info.parts.push_back({3, "a", true, false, 4});
  table.info.parts.back().thinnest = 0.75F;
  table.info.parts.back().thickest = 1.5F;
  table.info.parts.push_back({5, "b", false, true, 1});
  return table;
}

TEST(SnapshotTable, survives_a_round_trip) {
  const Result<SnapshotTable> table = decode_table(encode_table(sound_table()));
  ASSERT_TRUE(table) << table.error().text();
  ASSERT_EQ(table->info.parts.size(), 2u);
  const SnapshotPart &a = table->info.parts[0], &b = table->info.parts[1];
  EXPECT_EQ(std::tuple(a.id, a.name, a.hidden, a.locked, a.shells), std::tuple(3, "a", true, false, 4u));
  EXPECT_EQ(std::tuple(b.id, b.name, b.hidden, b.locked, b.shells), std::tuple(5, "b", false, true, 1u));
  EXPECT_EQ(std::pair(a.thinnest, a.thickest), std::pair(0.75F, 1.5F));
  EXPECT_EQ(table->arrays[1].pieces.at(0).offset, 128u);
}

TEST(SnapshotTable, what_goes_by_node_shell_or_line_has_one_count) {
  using enum SnapshotArray;
  const std::vector<SnapshotArray> families[] = {{positions, node_ids, node_marks},
                                                 {shell_nodes, shell_ids, shell_parts, shell_marks, shell_quality, shell_damage}};
  const auto with = [](std::initializer_list<std::pair<SnapshotArray, std::size_t>> counts, SnapshotTable table) {
    for (const auto& [array, count] : counts) {
      table.arrays[static_cast<std::size_t>(array)].count = count;
      table.arrays[static_cast<std::size_t>(array)].pieces.assign(count > 0, {0, 0, 1});
    }
    return decode_table(encode_table(table));
  };
  for (const std::vector<SnapshotArray>& family : families) {
    SnapshotTable sound;
    for (const SnapshotArray array : family) {
      sound.arrays[static_cast<std::size_t>(array)].count = 5;
      sound.arrays[static_cast<std::size_t>(array)].pieces.push_back({0, 0, 1});
    }
    EXPECT_TRUE(with({}, sound));
    for (const SnapshotArray array : family) EXPECT_FALSE(with({{array, 4}}, sound)) << static_cast<int>(array);
  }
  EXPECT_TRUE(with({{line_nodes, 6}, {line_parts, 3}}, {}));
  EXPECT_FALSE(with({{line_nodes, 6}, {line_parts, 6}}, {}));
}

TEST(SnapshotTable, a_broken_one_is_refused_or_harmless) {
  std::vector<std::byte> bytes = encode_table(sound_table());
  Descriptor memory = make_shared_memory("test", 4096).value();
  const auto segment = std::make_shared<const Mapping>(std::move(Mapping::map(memory, false).value()));
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::byte> broken = bytes;
    broken[random() % broken.size()] ^= static_cast<std::byte>(1u << random() % 8);
    if (i % 3 == 0) broken.resize(random() % broken.size() + 1);
    const auto view = SnapshotView::map(make_sealed_memory("test", broken).value(), std::vector{segment});
    if (!view) {
      ++refused;
      continue;
    }
    unsigned sum = 0;
    for (int a = 0; a < kSnapshotArrayCount; ++a)
      for (std::size_t c = 0; c < (*view)->chunk_count(static_cast<SnapshotArray>(a)); ++c)
        for (const std::byte byte : (*view)->chunk_bytes(static_cast<SnapshotArray>(a), c)) sum += static_cast<unsigned>(byte);
    EXPECT_EQ(sum, 0u);
  }
  EXPECT_GT(refused, 1000);
}

TEST(SnapshotTable, chunks_outside_their_segment_are_refused) {
  Descriptor memory = make_shared_memory("test", 4096).value();
  const auto segment = std::make_shared<const Mapping>(std::move(Mapping::map(memory, false).value()));
  SnapshotTable table = sound_table();
  table.arrays[0].pieces[0].offset = 4096 - 64;  // five positions take 120 bytes
  EXPECT_FALSE(SnapshotView::map(make_sealed_memory("test", encode_table(table)).value(), std::vector{segment}));
  table = sound_table();
  table.arrays[0].pieces[0].offset = ~std::uint64_t{63};
  EXPECT_FALSE(SnapshotView::map(make_sealed_memory("test", encode_table(table)).value(), std::vector{segment}));
  table = sound_table();
  table.arrays[0].pieces[0].segment = 1;
  EXPECT_FALSE(SnapshotView::map(make_sealed_memory("test", encode_table(table)).value(), std::vector{segment}));
  table = sound_table();
  table.arrays[1].count = 6;
  EXPECT_FALSE(SnapshotView::map(make_sealed_memory("test", encode_table(table)).value(), std::vector{segment}));
}

}  // namespace
}  // namespace prismesh::ipc
