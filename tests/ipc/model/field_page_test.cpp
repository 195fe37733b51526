#include "ipc/model/field_page.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "ipc/model/snapshot_publisher.h"
#include "tests/ipc/model/small_document.h"

namespace prismesh::ipc {
namespace {

TEST(FieldPage, brings_every_value_across) {
  const std::vector<float> values{1, std::numeric_limits<float>::quiet_NaN(), -3.5F};
  const auto sealed = seal_field(12, false, values);
  ASSERT_TRUE(sealed);
  const auto field = FieldValues::map(*sealed);
  ASSERT_TRUE(field) << field.error().text();
  EXPECT_EQ((*field)->generation(), 12u);
  EXPECT_FALSE((*field)->on_nodes());
  ASSERT_EQ((*field)->values().size(), 3u);
  EXPECT_EQ((*field)->values()[0], 1);
  EXPECT_TRUE(std::isnan((*field)->values()[1]));
  EXPECT_EQ((*field)->values()[2], -3.5F);
}

TEST(FieldPage, refuses_what_lies_about_itself) {
  const FieldHeader honest{FieldHeader::kMagic, 1, 4, 1};
  const auto map_of = [](const FieldHeader& header, std::size_t values_bytes) {
    std::vector<std::byte> bytes(sizeof header + values_bytes);
    std::memcpy(bytes.data(), &header, sizeof header);
    return FieldValues::map(make_sealed_memory("test", bytes).value());
  };
  EXPECT_TRUE(map_of(honest, 16));
  EXPECT_FALSE(map_of(honest, 12)) << "fewer values than it says";
  EXPECT_FALSE(map_of(honest, 17)) << "a part of a value";
  FieldHeader huge = honest;
  huge.count = (std::uint64_t{1} << 62) + 4;  // times four wraps round
  EXPECT_FALSE(map_of(huge, 16));
  FieldHeader other = honest;
  other.magic = 1;
  EXPECT_FALSE(map_of(other, 16));
  EXPECT_FALSE(FieldValues::map(make_sealed_memory("test", std::vector<std::byte>(8)).value())) << "no header";
  // Cut off behind a count that is right once the length has wrapped round.
  FieldHeader cut = honest;
  cut.count = (std::size_t{24} - sizeof(FieldHeader)) / sizeof(float);
  std::vector<std::byte> bytes(24);
  std::memcpy(bytes.data(), &cut, bytes.size());
  EXPECT_FALSE(FieldValues::map(make_sealed_memory("test", bytes).value()));
}

TEST(FieldPage, refuses_memory_that_can_still_be_written) {
  const auto open = make_shared_memory("test", sizeof(FieldHeader));
  ASSERT_TRUE(open);
  const FieldHeader empty;
  ASSERT_EQ(::pwrite(open->get(), &empty, sizeof empty, 0), static_cast<ssize_t>(sizeof empty));
  EXPECT_FALSE(FieldValues::map(*open));
}

TEST(Snapshot, older_states_are_leased_and_the_current_one_stays) {
  mesh::document::Document document = test::grid_document(100, 90);
  test::move_node(document, 10, {1, 2, 3});
  SnapshotPublisher publisher;
  const auto current = publisher.publish(document, true).value();
  const std::size_t copied = publisher.bytes_copied();
  const auto older = publisher.publish_other(document, 0, true);
  ASSERT_TRUE(older) << older.error().text();
  EXPECT_EQ(publisher.bytes_copied() - copied, mesh::kChunkSize * sizeof(mesh::Vec3)) << "only the chunk that differs";
  const auto view_of = [&](const PublishedSnapshot& snapshot) {
    std::vector<std::shared_ptr<const Mapping>> segments;
    for (const std::uint64_t id : snapshot.segments)
      segments.push_back(std::make_shared<const Mapping>(Mapping::map(*publisher.segment(id), false).value()));
    return SnapshotView::map(snapshot.table, segments).value();
  };
  EXPECT_EQ(view_of(*older)->info().generation, 1u);
  EXPECT_EQ(view_of(*older)->position(10), mesh::Vec3(10, 0, 0));
  publisher.release(older->lease);
  EXPECT_EQ(view_of(publisher.publish(document, true).value())->position(10), mesh::Vec3(1, 2, 3));
  EXPECT_EQ(publisher.publish(document, true)->segments, current.segments);
}

}  // namespace
}  // namespace prismesh::ipc
