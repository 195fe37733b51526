// Saving as another deck: the document afterwards, the previous deck, and the warnings before files are replaced.
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/clock.h"
#include "daemon/modeld/request_handler.h"
#include "mesh/document/edit_json.h"
#include "tests/daemon/modeld/folder.h"

namespace prismesh::modeld {
namespace {

namespace fs = std::filesystem;
using test::Folder;
using ::testing::ElementsAre;

class SaveAs : public ::testing::Test {
 protected:
  DocumentKeeper keeper() const { return DocumentKeeper(StateFolder(folder_.state())); }
  static void open(DocumentKeeper& keeper, const fs::path& deck) {
    ipc::Open request;
    request.path = deck.string();
    const Result<bool> opened = keeper.open(request, {});
    ASSERT_TRUE(opened) << opened.error().text();
  }
  static void edit(DocumentKeeper& keeper, const char* json) {
    const auto report = keeper.edit(mesh::document::parse_edit(json).value());
    ASSERT_TRUE(report) << report.error().text();
  }
  static double height(const DocumentKeeper& keeper, std::int64_t id) {
    const mesh::Model& model = keeper.document().current().model;
    return model.position(model.find_node(id)).z();
  }
  Folder folder_;
};

constexpr const char* kLift = R"({"edit":"translate","by":[0,0,0.25],"on":"1313","falloff":{"profile":"constant"}})";

TEST_F(SaveAs, goes_on_under_the_new_name_with_its_history) {
  const fs::path deck = folder_.sheet(), other = folder_.path() / "other.k";
  const std::string original = test::whole_file(deck);
  double start = 0;
  std::size_t warnings = 0;
  {
    DocumentKeeper first = keeper();
    open(first, deck);
    warnings = first.state().warnings.size();
    start = height(first, 1313);
    edit(first, kLift);
    const Result<ipc::Saved> saved = first.save_as(other.string());
    ASSERT_TRUE(saved) << saved.error().text();
    EXPECT_EQ(saved->path, other.string());
    EXPECT_EQ(first.state().path, other.string());
    EXPECT_FALSE(first.state().changed);
    EXPECT_THAT(first.state().files, ElementsAre(::testing::Field(&ipc::DeckFile::name, "other.k")));
    edit(first, R"({"edit":"undo"})");
    EXPECT_EQ(height(first, 1313), start);
    EXPECT_TRUE(first.state().changed);
    edit(first, R"({"edit":"redo"})");
    edit(first, kLift);
    ASSERT_TRUE(first.save(std::nullopt));
    EXPECT_EQ(test::whole_file(deck), original) << "what was to be kept";
    EXPECT_EQ(test::compare_decks(original, test::whole_file(other)).nodes.size(), 1u);
    edit(first, kLift);
    edit(first, R"({"edit":"select","expr":"file:other.k","kind":"part"})");
  }  // as if killed
  DocumentKeeper second = keeper();
  const Result<bool> again = second.reopen({});
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(second.state().path, other.string());
  EXPECT_NEAR(height(second, 1313), start + 0.75, 1e-9);
  ASSERT_TRUE(second.close(true));
  // The previous deck: as on disk, without the edits that were saved under the new name.
  open(second, deck);
  EXPECT_EQ(height(second, 1313), start);
  EXPECT_EQ(second.state().recovered_edits, 0u);
  EXPECT_EQ(second.state().warnings.size(), warnings);
}

TEST_F(SaveAs, takes_includes_and_structure_along) {
  const fs::path deck = folder_.two_files(), other = folder_.path() / "new/main.k";
  auto killed = std::make_unique<DocumentKeeper>(keeper());
  DocumentKeeper& first = *killed;
  open(first, deck);
  edit(first, R"({"edit":"translate","by":[0,0,0.25],"on":"5","falloff":{"profile":"constant"}})");
  edit(first, R"({"edit":"split","at":["shell:1"]})");
  const std::string main = test::whole_file(deck), rest = test::whole_file(folder_.path() / "rest.k");
  const Result<ipc::Saved> saved = first.save_as(other.string());
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(test::whole_file(deck), main);
  EXPECT_EQ(test::whole_file(folder_.path() / "rest.k"), rest);
  EXPECT_EQ(first.state().shells, 3u);
  EXPECT_THAT(saved->notes, ::testing::Contains(::testing::HasSubstr("the history begins anew")));
  edit(first, R"({"edit":"translate","by":[0,0,0.25],"on":"5","falloff":{"profile":"constant"}})");
  killed.reset();
  DocumentKeeper second = keeper();
  const Result<bool> again = second.reopen({});
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(second.state().path, other.string());
  EXPECT_EQ(second.state().shells, 3u);
  EXPECT_EQ(height(second, 5), 0.5);
}

TEST_F(SaveAs, reports_what_it_would_replace_and_create_and_changes_nothing) {
  const fs::path deck = folder_.two_files();
  ipc::SnapshotPublisher publisher(1);
  ManualClock clock;
  RequestHandler handler(StateFolder(folder_.state()), publisher, std::size_t{1} << 30, clock);
  ipc::Open request;
  request.path = deck.string();
  ASSERT_TRUE(std::holds_alternative<ipc::DocumentState>(handler.open(request, {}).answer));
  const auto ask = [&](const fs::path& target, bool asks) { return handler.save({target.string(), true, asks}).answer; };

  const fs::path made = folder_.path() / "new";
  ipc::Answer answer = ask(made / "main.k", true);
  ASSERT_TRUE(std::holds_alternative<ipc::SaveWould>(answer));
  EXPECT_THAT(std::get<ipc::SaveWould>(answer).make, ElementsAre(made.string()));
  EXPECT_THAT(std::get<ipc::SaveWould>(answer).replace, ElementsAre());
  EXPECT_FALSE(fs::exists(made));

  fs::create_directory(made);
  std::ofstream(made / "rest.k") << "mine\n";
  answer = ask(made / "main.k", true);
  ASSERT_TRUE(std::holds_alternative<ipc::SaveWould>(answer));
  EXPECT_THAT(std::get<ipc::SaveWould>(answer).replace, ElementsAre((made / "rest.k").string())) << "includes are written too";
  EXPECT_EQ(test::whole_file(made / "rest.k"), "mine\n");

  EXPECT_TRUE(std::holds_alternative<ipc::Saved>(ask(made / "main.k", false)));
  EXPECT_NE(test::whole_file(made / "rest.k"), "mine\n");
  EXPECT_TRUE(std::holds_alternative<ipc::Saved>(ask(made / "main.k", true))) << "its own files aren't asked about";
  answer = ask("elsewhere.k", true);
  ASSERT_TRUE(std::holds_alternative<ipc::Failed>(answer));
  EXPECT_THAT(std::get<ipc::Failed>(answer).message, ::testing::HasSubstr("absolute"));
}

TEST_F(SaveAs, a_copy_leaves_the_document_as_it_was) {
  const fs::path deck = folder_.sheet(), other = folder_.path() / "other.k";
  ipc::SnapshotPublisher publisher(1);
  ManualClock clock;
  RequestHandler handler(StateFolder(folder_.state()), publisher, std::size_t{1} << 30, clock);
  ipc::Open request;
  request.path = deck.string();
  ASSERT_TRUE(std::holds_alternative<ipc::DocumentState>(handler.open(request, {}).answer));
  ASSERT_TRUE(std::holds_alternative<ipc::Edited>(handler.edit(mesh::document::parse_edit(kLift).value()).answer));
  ipc::Save copy{other.string(), false, false, true};
  const Outcome copied = handler.save(copy);
  ASSERT_TRUE(std::holds_alternative<ipc::Saved>(copied.answer));
  EXPECT_NE(test::whole_file(other), test::whole_file(deck));
  ASSERT_TRUE(copied.published);
  EXPECT_EQ(copied.published->state.path, deck.string());
  EXPECT_TRUE(copied.published->state.changed) << "the deck itself doesn't have the edit";
  copy.stays_unsaved = false;
  EXPECT_FALSE(handler.save(copy).published->state.changed);
}

TEST_F(SaveAs, keeps_the_document_if_it_cannot_continue_as_the_new_deck) {
  const fs::path deck = folder_.sheet(), other = folder_.path() / "other.k";
  auto killed = std::make_unique<DocumentKeeper>(keeper());
  DocumentKeeper& first = *killed;
  open(first, deck);
  edit(first, kLift);
  const double lifted = height(first, 1313);
  const fs::path away = folder_.path() / "away";
  fs::rename(folder_.state(), away);
  std::ofstream(folder_.state()) << "no folder";  // so that no new journal can be created
  const Result<ipc::Saved> saved = first.save_as(other.string());
  fs::remove(folder_.state());
  fs::rename(away, folder_.state());
  ASSERT_FALSE(saved);
  EXPECT_THAT(saved.error().message, ::testing::HasSubstr("the document is still " + deck.string()));
  EXPECT_EQ(first.state().path, deck.string());
  EXPECT_TRUE(first.state().changed);
  edit(first, kLift);
  killed.reset();
  DocumentKeeper second = keeper();
  ASSERT_TRUE(second.reopen({}));
  EXPECT_EQ(second.state().path, deck.string());
  EXPECT_NEAR(height(second, 1313), lifted + 0.25, 1e-9);
}

TEST_F(SaveAs, does_not_go_on_as_a_deck_that_is_read_as_another_model) {
  // The new deck shares its include with the old one; another program has meanwhile added a node or a shell to it.
  const std::pair<std::string, std::string> additions[] = {
      {"*NODE\n", "       7             9.0             9.0             0.0\n"},
      {"*ELEMENT_SHELL\n", "       3       1       1       2       3\n"},
  };
  for (const auto& [keyword, card] : additions) {
    const fs::path deck = folder_.two_files(), other = folder_.path() / "other.k", include = folder_.path() / "rest.k";
    DocumentKeeper first = keeper();
    open(first, deck);
    edit(first, R"({"edit":"translate","by":[0,0,0.25],"on":"1","falloff":{"profile":"constant"}})");
    std::string text = test::whole_file(include);
    text.insert(text.find(keyword) + keyword.size(), card);
    std::ofstream(include) << text;
    const Result<ipc::Saved> saved = first.save_as(other.string());
    ASSERT_FALSE(saved) << card;
    EXPECT_EQ(first.state().path, deck.string());
    EXPECT_TRUE(first.changed());
    ASSERT_TRUE(first.close(true));
    fs::remove(other);
  }
}

TEST_F(SaveAs, opens_another_deck_without_the_edits_only_after_reading_it) {
  const fs::path deck = folder_.sheet();
  DocumentKeeper first = keeper();
  open(first, deck);
  edit(first, kLift);
  const double lifted = height(first, 1313);
  ipc::Open request;
  request.path = (folder_.path() / "missing.k").string();
  request.discard = true;
  EXPECT_FALSE(first.open(request, {}));
  EXPECT_EQ(height(first, 1313), lifted) << "no edit was discarded for a deck that can't be opened";
  request.path = folder_.two_files().string();
  request.discard = false;
  EXPECT_FALSE(first.open(request, {}));
  request.discard = true;
  ASSERT_TRUE(first.open(request, {}));
  EXPECT_EQ(first.state().path, request.path);
  DocumentKeeper second = keeper();
  open(second, deck);
  EXPECT_EQ(second.state().recovered_edits, 0u);
}

}  // namespace
}  // namespace prismesh::modeld
