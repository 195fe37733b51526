// Documents whose deck nobody vouches for: prismesh-import reads it and makes its new text; the bytes are those that would be written
// without.
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/modeld/document_keeper.h"
#include "mesh/document/edit_json.h"
#include "tests/daemon/modeld/folder.h"
#include "tests/support/places.h"

namespace prismesh::modeld {
namespace {

namespace fs = std::filesystem;
using test::Folder;
using ::testing::HasSubstr;

constexpr auto kSplitFirst = R"({"edit":"split","at":["shell:1"]})";
constexpr auto kMoveFirst = R"({"edit":"translate","by":[0,0,0.05],"on":"1"})";

class Sandboxed : public ::testing::Test {
 protected:
  /// A script that notes each use of prismesh-import, and runs it.
  void SetUp() override {
    program_ = folder_.path() / "importer";
    become("echo used >> '" + (folder_.path() / "uses").string() + "'; exec '" + (test::programs_folder() / "prismesh-import").string() +
           "'");
  }
  void become(const std::string& script) const {
    std::ofstream(program_) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(program_, fs::perms::owner_all);
  }
  long uses() const {
    const std::string lines = fs::exists(folder_.path() / "uses") ? test::whole_file(folder_.path() / "uses") : "";
    return std::count(lines.begin(), lines.end(), '\n');
  }
  DocumentKeeper keeper() const {
    return DocumentKeeper(StateFolder(folder_.state()), mesh::document::OpenOptions{}.history_bytes, DeckSource({{}, program_}));
  }
  static void open(DocumentKeeper& keeper, const fs::path& deck, bool sandboxed = true) {
    ipc::Open request;
    request.path = deck.string();
    request.sandboxed = sandboxed;
    const Result<bool> opened = keeper.open(request, {});
    ASSERT_TRUE(opened) << opened.error().text();
  }
  static void edit(DocumentKeeper& keeper, const char* json) {
    const auto report = keeper.edit(mesh::document::parse_edit(json).value());
    ASSERT_TRUE(report) << report.error().text();
  }

  Folder folder_;
  fs::path program_;
};

TEST_F(Sandboxed, saves_the_bytes_that_are_saved_without_a_sandbox) {
  const fs::path deck = folder_.two_files();
  const fs::path here = folder_.path() / "here/main.k", there = folder_.path() / "there/main.k";
  for (const fs::path& copy : {here, there}) fs::create_directories(copy.parent_path());
  DocumentKeeper plain = keeper();
  open(plain, deck, false);
  edit(plain, kSplitFirst);
  edit(plain, kMoveFirst);
  ASSERT_TRUE(plain.save(here.string()));
  ASSERT_TRUE(plain.close(true));
  EXPECT_EQ(uses(), 0);

  DocumentKeeper sandboxed = keeper();
  open(sandboxed, deck);
  EXPECT_EQ(uses(), 1);
  edit(sandboxed, kSplitFirst);
  edit(sandboxed, kMoveFirst);
  const Result<ipc::Saved> saved = sandboxed.save(there.string());
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(uses(), 2);
  for (const char* name : {"main.k", "rest.k"})
    EXPECT_EQ(test::whole_file(here.parent_path() / name), test::whole_file(there.parent_path() / name)) << name;
  EXPECT_NE(test::whole_file(there.parent_path() / "rest.k"), test::whole_file(folder_.path() / "rest.k"));
}

TEST_F(Sandboxed, is_saved_in_place_and_goes_on) {
  const fs::path deck = folder_.two_files();
  DocumentKeeper first = keeper();
  open(first, deck);
  edit(first, kMoveFirst);
  edit(first, kSplitFirst);
  const Result<ipc::Saved> saved = first.save(std::nullopt);
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(uses(), 3) << "reading, rewriting, reading what was written";
  EXPECT_FALSE(first.state().changed);
  edit(first, kMoveFirst);
  ASSERT_TRUE(first.save(std::nullopt)) << "a second time";
  EXPECT_EQ(first.state().shells, 3u);
  first = keeper();
  DocumentKeeper second = keeper();
  open(second, deck, false);
  EXPECT_EQ(second.state().shells, 3u);
  EXPECT_DOUBLE_EQ(second.document().current().model.position(second.document().current().model.find_node(1)).z(), 0.1);
}

TEST_F(Sandboxed, comes_back_sandboxed_after_a_restart_with_its_edits) {
  const fs::path deck = folder_.two_files(), other = folder_.path() / "other";
  DocumentKeeper first = keeper();
  open(first, deck);
  edit(first, kSplitFirst);
  first = keeper();
  const long before = uses();
  DocumentKeeper second = keeper();
  ASSERT_TRUE(second.reopen({}).value());
  EXPECT_EQ(uses(), before + 1);
  EXPECT_EQ(second.state().shells, 3u);
  fs::create_directory(other);
  ASSERT_TRUE(second.save_as((other / "main.k").string()));
  EXPECT_EQ(second.state().path, (other / "main.k").string());
  EXPECT_FALSE(second.state().changed);
  edit(second, kMoveFirst);
  const Result<ipc::Saved> again = second.save(std::nullopt);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(uses(), before + 5);
}

TEST_F(Sandboxed, reads_no_settings_beside_the_deck) {
  const fs::path deck = folder_.two_files();
  std::ofstream(folder_.path() / "main.k.prismesh.toml") << "not = [a settings file\n";
  DocumentKeeper keeper_of = keeper();
  open(keeper_of, deck);
  EXPECT_TRUE(keeper_of.is_open());
}

TEST_F(Sandboxed, whose_reader_dies_loses_nothing) {
  const fs::path deck = folder_.two_files();
  const std::string main = test::whole_file(deck), rest = test::whole_file(folder_.path() / "rest.k");
  DocumentKeeper first = keeper();
  open(first, deck);
  edit(first, kSplitFirst);
  become("kill -SEGV $$");
  const Result<ipc::Saved> saved = first.save(std::nullopt);
  ASSERT_FALSE(saved);
  EXPECT_THAT(saved.error().text(), HasSubstr("crashed"));
  EXPECT_EQ(test::whole_file(deck), main);
  EXPECT_EQ(test::whole_file(folder_.path() / "rest.k"), rest);
  EXPECT_TRUE(first.state().changed);
  SetUp();
  edit(first, kMoveFirst);
  const Result<ipc::Saved> again = first.save(std::nullopt);
  EXPECT_TRUE(again) << again.error().text();
}

TEST_F(Sandboxed, isnt_saved_over_a_deck_that_changed_on_disk) {
  const fs::path deck = folder_.two_files();
  DocumentKeeper first = keeper();
  open(first, deck);
  edit(first, kMoveFirst);
  std::ofstream(folder_.path() / "rest.k", std::ios::app) << "$ by someone else\n";
  const Result<ipc::Saved> copy = first.save_copy((folder_.path() / "copy.k").string());
  ASSERT_FALSE(copy);
  EXPECT_THAT(copy.error().text(), HasSubstr("has changed on disk since it was opened"));
}

}  // namespace
}  // namespace prismesh::modeld
