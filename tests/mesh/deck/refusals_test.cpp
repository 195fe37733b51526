// Edits and saves that are refused: the sentence, and the file and line it names. Mostly LS-DYNA decks; the rules are every format's.
#include <functional>

#include "base/compression.h"
#include "mesh/deck/open.h"
#include "mesh/deck/sample.h"
#include "mesh/deck/save.h"
#include "mesh/deck/staged_save.h"
#include "mesh/deck/writing/card_writer.h"
#include "tests/mesh/deck/growing.h"

namespace prismesh::mesh::deck {
namespace {

/// Two quads, 11 (1 2 5 4) and 12 (2 3 6 5).
const std::string kTwoQuads =
    "*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,2.,0.,0.\n4,0.,1.,0.\n5,1.,1.,0.\n6,2.,1.,0.\n"
    "*ELEMENT_SHELL\n11,7,1,2,5,4\n12,7,2,3,6,5\n";
const char kTwice[] = "*INCLUDE\na.k\n*INCLUDE\na.k\n";

using EditIt = std::function<void(Growing&)>;

/// "deck.k:12: why it can't be saved"; `include` is a.k, `second` b.k.
std::string why_not(const std::string& text, const EditIt& edit_it, const std::string& include = "", const std::string& second = "") {
  const DeckFolder folder;
  folder.write("a.k", include);
  folder.write("b.k", second);
  const auto opened = folder.open(text);
  if (!opened) return opened.error().text();
  Growing edit(*opened);
  edit_it(edit);
  const auto may = can_save(edit.deck, edit.original, edit.model);
  if (may) return "";
  const auto saved = save(edit.deck, edit.original, edit.model, folder / "out/deck.k");
  EXPECT_FALSE(saved);
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  const std::string suffix = "; nothing was written";
  std::string message = may.error().message;
  EXPECT_EQ(message.substr(message.size() - std::min(message.size(), suffix.size())), suffix) << message;
  message.resize(message.size() - std::min(message.size(), suffix.size()));
  return std::filesystem::path(may.error().file).filename().string() + ":" + std::to_string(may.error().line) + ": " + message;
}

void middle_of_first_edge(Growing& edit) { edit.middle(edit.node(1), edit.node(2)); }
void split_first(Growing& edit) { edit.split_in_four(edit.shell(11)); }

TEST(Refusals, a_constraint_that_names_its_node_by_a_parameter_is_said_to) {
  const std::string parameters = kTwoQuads + "*PARAMETER\nI A, 1\nI B, 2\n*BOUNDARY_SPC_NODE\n";
  EXPECT_EQ(why_not(parameters + "&A,0,1,1,1\n&B,0,1,1,1\n", middle_of_first_edge),
            "deck.k:15: the new node 7 can't have a card like this one: *BOUNDARY_SPC_NODE names it by the parameter &A");
  EXPECT_EQ(why_not(parameters + "1,0,1,1,1\n&B,0,1,1,1\n", middle_of_first_edge),
            "deck.k:16: the new node 7 can't have a card like this one: *BOUNDARY_SPC_NODE names it by the parameter &B");
  EXPECT_EQ(why_not(kTwoQuads + "*BOUNDARY_SPC_NODE\n1,0,1,1,1\n2,0,1,1,0\n", middle_of_first_edge),
            "deck.k:12: the new node 7 lies between nodes that *BOUNDARY_SPC_NODE holds in different ways");
}

TEST(Refusals, of_cards_in_an_include_that_is_used_twice) {
  const std::string twice = kTwoQuads + kTwice, mesh = "*NODE\n9,9.,9.,9.\n";
  EXPECT_EQ(why_not(twice, split_first, mesh + "*SET_SEGMENT\n1\n1,2,5,4\n"),
            "a.k:5: *SET_SEGMENT 1 stands in an include that is used twice, and a segment of it would have to change");
  EXPECT_EQ(why_not(twice, middle_of_first_edge, mesh + "*SET_NODE_LIST\n1\n1,2\n"),
            "a.k:3: *SET_NODE_LIST 1 stands in an include that is used twice, and it would have to change");
  EXPECT_EQ(why_not(twice, middle_of_first_edge, mesh + "*BOUNDARY_SPC_NODE\n1,0,1,1,1\n2,0,1,1,1\n"),
            "a.k:4: *BOUNDARY_SPC_NODE stands in an include that is used twice, and it would have to name new ones");
}

TEST(Refusals, of_a_mesh_in_an_include_that_is_used_twice) {
  const std::string spare = "*NODE\n9,9.,9.,9.\n*ELEMENT_SHELL\n13,7,1,2,5,5\n";
  const auto refused = [&](const EditIt& edit_it) { return why_not(kTwice, edit_it, kTwoQuads + spare); };
  EXPECT_EQ(refused([](Growing& edit) {
              add_node(edit.model, 99, {.5, 0, 0}, edge_origin(edit.node(1), edit.node(2)));
            }),
            "deck.k:0: node 99 would have to stand in an include that is used twice, or beside nodes that have no cards of their own");
  EXPECT_EQ(refused([](Growing& edit) { remove_node(edit.model, edit.node(9)); }),
            "a.k:12: node 9 stands in an include that is used more than once or can't be transformed back; it can't be removed");
  EXPECT_EQ(refused([](Growing& edit) { remove_shell(edit.model, edit.shell(13)); }),
            "a.k:14: shell 13 stands in an include that is used twice; it can't be removed");
  EXPECT_EQ(refused([](Growing& edit) {
              set_shell_nodes(edit.model, edit.shell(11), {{edit.node(1), edit.node(2), edit.node(5), edit.node(5)}});
            }),
            "a.k:9: shell 11 stands in an include that is used twice; it can't be changed");
  const DeckFolder folder;
  folder.write("a.k", kTwoQuads);
  const auto opened = folder.open(kTwice);
  ASSERT_OPENED(opened);
  Growing edit(*opened);
  const auto id = edit.ids.node(edge_origin(edit.node(1), edit.node(2)));
  ASSERT_FALSE(id);
  EXPECT_EQ(id.error().message,
            "a new node would have to stand in an include that is used twice, or beside nodes that have no cards of their own");
}

TEST(Refusals, of_ids_that_a_shifted_include_cant_name) {
  const std::string shifted = kTwoQuads + "*INCLUDE_TRANSFORM\na.k\n1000,1000,0\n*END\n";
  const std::string include = "*NODE\n1,0.,5.,0.\n2,1.,5.,0.\n3,1.,6.,0.\n4,0.,6.,0.\n*ELEMENT_SHELL\n1,7,1,2,3,4\n";
  EXPECT_EQ(why_not(
                shifted,
                [](Growing& edit) {
                  add_node(edit.model, 500, {.5, 5, 0}, edge_origin(edit.node(1001), edit.node(1002)));
                },
                include),
            "a.k:3: the new node 500 has an id that doesn't fit the fields of the cards beside it");
  EXPECT_EQ(why_not(
                shifted,
                [](Growing& edit) {
                  const auto n = edit.model.shell(edit.shell(1001)).node;
                  set_shell_nodes(edit.model, edit.shell(1001), {{n[0], n[1], n[2], edit.node(4)}});
                },
                include),
            "a.k:7: shell 1001 has a node whose id doesn't fit the fields of its card");
  EXPECT_EQ(why_not(
                shifted,
                [](Growing& edit) {
                  const auto n = edit.model.shell(edit.shell(1001)).node;
                  add_shell(edit.model, 500, {{n[0], n[1], n[2], n[2]}}, edit.shell(1001));
                },
                include),
            "a.k:7: the new shell 500 has an id that doesn't fit the fields of the cards beside it");
}

TEST(Refusals, of_a_set_in_an_include_whose_shift_isnt_known) {
  const std::string text = kTwoQuads + "*INCLUDE_TRANSFORM\na.k\n1000,1000,0\n*INCLUDE\nb.k\n*END\n", far = "*NODE\n1,9.,9.,9.\n";
  EXPECT_EQ(
      why_not(text, middle_of_first_edge, far, "*SET_NODE_LIST\n1\n1,2\n"),
      "b.k:1: *SET_NODE_LIST 1 stands in an include without a mesh, so that it isn't known by how much its ids are shifted, and it would "
      "have to change");
  EXPECT_EQ(why_not(text, middle_of_first_edge, far, "*NODE\n8,8.,8.,8.\n*SET_NODE_LIST\n1\n1,2\n"), "") << "its nodes tell";
}

TEST(Refusals, of_models_that_cards_cant_say) {
  EXPECT_EQ(why_not(kTwoQuads + "*ELEMENT_SHELL\n13,8,1,2,5,4\n",
                    [](Growing& edit) { edit.model.shell_parts.set(0, edit.model.shell_parts[2]); }),
            "deck.k:9: shell 11 has another part than its card, which this version can't write");
  EXPECT_EQ(why_not(kTwoQuads,
                    [](Growing& edit) {
                      const NodeIndex middle = edit.middle(edit.node(1), edit.node(2));
                      const auto n = edit.model.shell(edit.shell(11)).node;
                      set_shell_nodes(edit.model, edit.shell(11), {{middle, n[1], n[2], n[3]}});
                      remove_node(edit.model, middle);
                    }),
            "deck.k:0: shell 11 has node 7, which was removed again");
  EXPECT_EQ(why_not(kTwoQuads, [](Growing& edit) { remove_node(edit.model, edit.node(3)); }),
            "deck.k:4: node 3 can't be removed: shell 12 has it");
  EXPECT_EQ(why_not(kTwoQuads + "*ELEMENT_BEAM\n21,9,1,3,2\n",
                    [](Growing& edit) {
                      remove_shell(edit.model, edit.shell(12));
                      remove_node(edit.model, edit.node(3));
                    }),
            "deck.k:4: node 3 can't be removed: beam 21 has it");
}

/// All that a writer has to say for itself: what it doesn't, the base class says.
class SilentWriter : public CardWriter {
 public:
  std::size_t node_end(const CardRef&) const override { return 0; }
  std::size_t shell_end(const CardRef&) const override { return 0; }
  std::optional<Vec3> node_coordinates(const CardRef&) const override { return {}; }
  WrittenCard move_node(const CardRef&, const Vec3&, const Vec3&) const override { return {}; }
  WrittenCard new_node(const CardRef&, std::int64_t, const Vec3&) const override { return {}; }
  Result<WrittenCard> shell(const CardRef&, const ShellCard&) const override { return WrittenCard(); }
  bool holds_triangles_and_quads(const CardRef&) const override { return false; }
  Result<std::vector<Replacement>> join(std::string_view, const Referrer&, std::span<const std::int64_t>) const override {
    return std::vector<Replacement>(1);
  }
  std::int64_t largest_node_id(std::uint16_t) const override { return 1; }
  std::int64_t largest_shell_id(std::uint16_t) const override { return 1; }
};

TEST(Refusals, a_format_that_says_nothing_of_a_card_refuses_to_change_it) {
  const SilentWriter writer;
  const std::vector<std::int64_t> ids{1}, none;
  EXPECT_EQ(writer.new_constrained_node({"", 0, 0}, 1, {}).error().message, "has constraints that can't be given to a new node");
  EXPECT_EQ(writer.shell_in_manner({"", 0, 0}, {"", 0, 0}, {}).error().message, "stands on a card whose kind says how many corners it has");
  EXPECT_EQ(writer.block_of_kind({"", 0, 0}, true).error().message,
            "stands on a card whose kind says how many corners it has, and its part has none of the other kind");
  EXPECT_EQ(writer.shell_in_block({"", 0, 0}, {}).error().message, "stands on a card whose kind says how many corners it has");
  EXPECT_EQ(writer.change_list("", {}, none, ids).error().message, "can't have an entry taken out");
  EXPECT_EQ(writer.change_list("", {}, ids, none)->size(), 1u) << "joining alone is join's";
  EXPECT_EQ(writer.replace_segment("", {}, 0, {}).error().message, "can't have a segment replaced");
  EXPECT_EQ(writer.inheritance({}, Referred::node), Inheritance::forbids);
  EXPECT_EQ(writer.copy_single("", {}, {}, ids).error().message, "can't be written again for another");
}

TEST(SaveElsewhere, beside_the_old_deck_an_include_that_was_saved_before_counts_as_changed) {
  const DeckFolder folder;
  folder.write("a.k", "*NODE\n2,2.,0.,0.\n");
  const auto opened = folder.open("*INCLUDE\na.k\n*NODE\n1,1.,0.,0.\n");
  ASSERT_OPENED(opened);
  ASSERT_TRUE(save(*opened->deck, opened->model, with_node_at(opened->model, 2, {4, 0, 0}), folder / "deck.k"));
  // As it was read, it would need the include as it was read: but that says something else by now.
  const auto refused = save(*opened->deck, opened->model, opened->model, folder / "copy.k");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().file, (folder / "a.k").string());
  EXPECT_EQ(
      refused.error().message,
      "is an include that has changed, and a deck saved under another name beside the old one would share it; save into another folder");
  EXPECT_FALSE(std::filesystem::exists(folder / "copy.k"));
  ASSERT_TRUE(save(*opened->deck, opened->model, opened->model, folder / "out/copy.k"));
  EXPECT_EQ(content(folder / "out/a.k"), "*NODE\n2,2.,0.,0.\n");
}

TEST(SaveElsewhere, targets_are_told_or_refused_as_saving_does) {
  const DeckFolder folder;
  folder.write("src/a.k", "*NODE\n2,2.,0.,0.\n");
  folder.write("common.k", "*NODE\n3,3.,0.,0.\n");
  const auto opened = deck::open(folder.write("src/deck.k", "*INCLUDE\na.k\n*NODE\n1,1.,0.,0.\n"));
  ASSERT_OPENED(opened);
  const auto targets = StagedSave::targets(*opened->deck, opened->model, opened->model, folder / "out/new.k");
  ASSERT_TRUE(targets);
  EXPECT_EQ(*targets, (std::vector<std::filesystem::path>{folder / "out/a.k", folder / "out/new.k"}));
  const Model nowhere = with_node_at(opened->model, 1, {std::nan(""), 0, 0});
  const auto no_place = StagedSave::targets(*opened->deck, opened->model, nowhere, folder / "out/new.k");
  ASSERT_FALSE(no_place);
  EXPECT_EQ(no_place.error().line, 4);
  EXPECT_EQ(no_place.error().message, "node 1 has been moved to a place that is no number; nothing was written");
  const auto outside = deck::open(folder.write("src/deck.k", "*INCLUDE\n../common.k\n*NODE\n1,1.,0.,0.\n"));
  ASSERT_OPENED(outside);
  const auto stays = StagedSave::targets(*outside->deck, outside->model, outside->model, folder / "out/new.k");
  ASSERT_FALSE(stays);
  EXPECT_EQ(stays.error().message, "is an include outside the main file's folder, so the deck can't be saved into another folder");
}

TEST(SaveReport, says_what_encrypted_text_may_hide) {
  const DeckFolder folder;
  const auto opened = folder.open("*KEYWORD\n" + kTwoQuads + "-----BEGIN PGP MESSAGE-----\nabc\n-----END PGP MESSAGE-----\n*END\n");
  ASSERT_OPENED(opened);
  Growing edit(*opened);
  split_first(edit);
  const auto saved = save(edit.deck, edit.original, edit.model, folder / "deck.k");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->notes, std::vector<std::string>{"the encrypted text at " + (folder / "deck.k").string() +
                                                   ":12 may hold sets, which the new nodes and shells haven't joined"});
  const auto moved = save(edit.deck, edit.original, with_node_at(edit.original, 1, {0, 0, 5}), folder / "deck.k");
  ASSERT_TRUE(moved) << moved.error().text();
  EXPECT_TRUE(moved->notes.empty()) << "nothing is new";
}

TEST(SaveTakenBack, only_while_the_files_are_what_it_has_written) {
  const DeckFolder folder;
  const std::string text = "*NODE\n1,1.,0.,0.\n";
  const auto opened = folder.open(text);
  ASSERT_OPENED(opened);
  const auto written = [&](double x) {
    auto staged = StagedSave::write(*opened->deck, opened->model, with_node_at(opened->model, 1, {x, 0, 0}), folder / "deck.k");
    EXPECT_TRUE(staged) << staged.error().text();
    EXPECT_TRUE(staged->put_in_place());
    EXPECT_EQ(staged->files().size(), 1u);
    return staged;
  };
  auto first = written(2);
  EXPECT_EQ(content(folder / "deck.k"), "*NODE\n1,2.0,0.,0.\n");
  ASSERT_TRUE(first->take_back());
  EXPECT_EQ(content(folder / "deck.k"), text);

  auto changed = written(3);
  folder.write("deck.k", "*NODE\n1,9.0,0.,0.\n");
  const auto by_others = changed->take_back();
  ASSERT_FALSE(by_others);
  EXPECT_EQ(by_others.error().file, (folder / "deck.k").string());
  EXPECT_EQ(by_others.error().message, "has been changed by something else meanwhile");
  EXPECT_EQ(content(folder / "deck.k"), "*NODE\n1,9.0,0.,0.\n");
  std::filesystem::remove(folder / "deck.k");
  const auto gone = changed->take_back();
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().message, "has been changed by something else meanwhile");
}

TEST(SaveTakenBack, not_over_an_earlier_save) {
  const DeckFolder folder;
  const auto opened = folder.open("*NODE\n1,1.,0.,0.\n");
  ASSERT_OPENED(opened);
  ASSERT_TRUE(save(*opened->deck, opened->model, with_node_at(opened->model, 1, {2, 0, 0}), folder / "deck.k"));
  auto staged = StagedSave::write(*opened->deck, opened->model, with_node_at(opened->model, 1, {3, 0, 0}), folder / "deck.k");
  ASSERT_TRUE(staged);
  ASSERT_TRUE(staged->put_in_place());
  const auto refused = staged->take_back();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "can't be given back what it held: the deck was saved over before");
  EXPECT_EQ(content(folder / "deck.k"), "*NODE\n1,3.0,0.,0.\n");
}

TEST(SaveStopped, while_it_packs_it_leaves_the_packed_deck_alone) {
  const DeckFolder folder;
  const std::string like("\x28\xb5\x2f\xfd\x24\x06\x31\x00\x00hello\n\x53\x88\xbd\x91", 19);
  const std::string_view text = "*NODE\n1,1.,0.,0.\n";
  const std::string packed = pack(std::span(&text, 1), std::as_bytes(std::span(like))).value();
  const auto opened = folder.open(packed);
  ASSERT_OPENED(opened);
  int stop = 0;
  for (bool done = false; !done; ++stop) {
    int asked = 0;
    const auto saved = save(*opened->deck, opened->model, with_node_at(opened->model, 1, {2, 0, 0}), folder / "deck.k",
                            [&](double) { return asked++ < stop; });
    done = saved.has_value();
    if (done) break;
    EXPECT_EQ(saved.error().message, cancelled().message);
    EXPECT_EQ(content(folder / "deck.k"), packed);
    ASSERT_LT(stop, 100);
  }
  EXPECT_GE(stop, 2);
  const auto again = deck::open(folder / "deck.k");
  ASSERT_OPENED(again);
  EXPECT_EQ(again->deck->files[0].bytes.text(), "*NODE\n1,2.0,0.,0.\n");
}

TEST(SampleStopped, writes_no_file) {
  const DeckFolder folder;
  int stop = 0;
  for (bool done = false; !done; ++stop) {
    int asked = 0;
    const auto written = write_sample(folder / "sample.k", kSampleShellsMin, [&](double) { return asked++ < stop; });
    done = written.has_value();
    EXPECT_EQ(std::filesystem::exists(folder / "sample.k"), done);
    if (done) break;
    EXPECT_EQ(written.error().message, cancelled().message);
    ASSERT_LT(stop, 1000);
  }
  EXPECT_GE(stop, 2);
}

}  // namespace
}  // namespace prismesh::mesh::deck
