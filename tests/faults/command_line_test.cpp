// The power is cut at every call of a command that writes a deck of several files, in place or over another deck: whoever reads that deck
// next, as any program of this project does, gets one state.
#include <gtest/gtest.h>

#include "mesh/deck/open.h"
#include "tests/faults/power_cut.h"
#include "tests/faults/session.h"
#include "tests/station/process.h"
#include "tests/support/places.h"
#include "tests/support/seed.h"

namespace prismesh::modeld::faults {
namespace {

namespace fs = std::filesystem;
using test::DiskState;
using test::FileCall;
using test::Survives;

/// Runs `prismesh edit` and records its file calls.
std::vector<FileCall> calls_of_an_edit(const Root& root, const fs::path& deck, const fs::path& output) {
  test::Process edit({(test::programs_folder() / "prismesh").string(), "edit", deck.string(), "--edit",
                      R"({"edit":"translate","by":[0,0,0.5],"on":"all"})", "-o", output.string()},
                     {{"LD_PRELOAD", (test::programs_folder() / "libfile_calls_preload.so").string()},
                      {"PRISMESH_FILE_CALLS_BELOW", root.disk().string()},
                      {"PRISMESH_FILE_CALLS_LOG", root.log().string()}});
  EXPECT_EQ(edit.wait_for_exit(), 0) << edit.standard_error();
  return test::read_file_calls(root.log());
}

class CommandLine : public ::testing::TestWithParam<const char*> {};

TEST_P(CommandLine, leaves_a_deck_of_one_state_whenever_it_is_cut_off) {
  const Root root;
  const auto session = std::find_if(sessions().begin(), sessions().end(), [](const Session& each) { return each.name == "saved_over"; });
  const Place place{root.disk(), session->write_deck(root.disk())};
  const fs::path output = root.disk() / GetParam();
  const DiskState before = test::disk_state_of(root.disk());
  const Files unsaved = deck_files(place);
  const std::vector<FileCall> calls = calls_of_an_edit(root, place.deck, output);
  ASSERT_GT(calls.size(), 10u);
  const Files saved = deck_files(place);
  ASSERT_NE(saved, unsaved);
  std::mt19937_64 random(test::seed(3));
  std::size_t states = 0, finished = 0;
  for (std::size_t count = 0; count <= calls.size(); ++count)
    for (const Survives survives : {Survives::all, Survives::flushed, Survives::in_order, Survives::any, Survives::any, Survives::any}) {
      SCOPED_TRACE("after " + std::to_string(count) + " calls, " + std::to_string(static_cast<int>(survives)));
      test::restore(test::after_power_cut(before, calls, count, survives, random));
      const Result<mesh::deck::OpenedDeck> opened = mesh::deck::open(output);
      ASSERT_TRUE(opened) << opened.error().text();
      const Files found = deck_files(place);
      ASSERT_TRUE(found == unsaved || found == saved) << "the deck is a mixture";
      ++states;
      for (const mesh::deck::Warning& warning : opened->deck->warnings) finished += warning.kind == "save-finished" ? 1 : 0;
      const DiskState left = test::disk_state_of(root.disk());
      for (const auto& [path, content] : left.files) ASSERT_FALSE(path.ends_with(".saving")) << path;
    }
  EXPECT_GT(finished, 4u);
  std::printf("%zu states of the disk, %zu saves were finished by reading\n", states, finished);
}

INSTANTIATE_TEST_SUITE_P(Targets, CommandLine, ::testing::Values("main.k", "as/other.k"),
                         [](const auto& tested) { return std::string(tested.param) == "main.k" ? "in_place" : "over_another_deck"; });

}  // namespace
}  // namespace prismesh::modeld::faults
