// What edits write into starter decks: new nodes and shells, lists, segments, blocks of the other kind. The wanted text is written down.
#include "mesh/deck/open.h"
#include "mesh/deck/radioss/writer.h"
#include "mesh/deck/save.h"

#include "mesh/deck/editing/edit_checks.h"
#include "mesh/deck/formats/formats.h"
#include "tests/mesh/deck/growing.h"
#include "tests/mesh/deck/radioss/starter_deck.h"

namespace prismesh::mesh::deck {
namespace {

const auto kStarterWriter = radioss::card_writer();
constexpr std::uint16_t kOldQuad = 1, kTriangle = 2;

/// Two quads, 11 (1 2 5 4) and 12 (2 3 6 5).
std::string six_nodes(std::size_t width = 10) {
  return "/NODE\n" + node(1, "0", "0", "0", width) + node(2, "1", "0", "0", width) + node(3, "2", "0", "0", width) +
         node(4, "0", "1", "0", width) + node(5, "1", "1", "0", width) + node(6, "2", "1", "0", width);
}
std::string two_quads(std::size_t width = 10) { return "/SHELL/1\n" + card({11, 1, 2, 5, 4}, width) + card({12, 2, 3, 6, 5}, width); }

/// 11 divided into four: 7 lies between 1 and 2, 8 between 2 and 5, 9 between 5 and 4, 10 between 4 and 1, 11 in the middle.
std::string eleven_nodes(std::size_t width = 10) {
  return "/NODE\n" + node(1, "0", "0", "0", width) + node(2, "1", "0", "0", width) + node(7, "0.5", "0.0", "0.0", width) +
         node(3, "2", "0", "0", width) + node(4, "0", "1", "0", width) + node(10, "0.0", "0.5", "0.0", width) +
         node(5, "1", "1", "0", width) + node(8, "1.0", "0.5", "0.0", width) + node(9, "0.5", "1.0", "0.0", width) +
         node(11, "0.5", "0.5", "0.0", width) + node(6, "2", "1", "0", width);
}
std::string five_quads(std::size_t width = 10) {
  return "/SHELL/1\n" + card({11, 1, 7, 11, 10}, width) + card({13, 7, 2, 8, 11}, width) + card({14, 11, 8, 5, 9}, width) +
         card({15, 10, 11, 9, 4}, width) + card({12, 2, 3, 6, 5}, width);
}

std::string with_crlf(std::string text) {
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "\r\n");
  return text;
}

class RadiossWriting : public Radioss {
 protected:
  Growing& edit(const std::string& text) {
    auto opened = open(text);
    if (!opened) throw std::runtime_error(opened.error().text());
    opened_ = std::move(*opened);
    edit_.emplace(opened_);
    return *edit_;
  }
  /// The saved text, which reads as the edited model.
  std::string written(const char* file = "deck_0000.rad") {
    const auto report = save(*opened_.deck, opened_.model, edit_->model, folder_ / "out/deck_0000.rad");
    EXPECT_TRUE(report) << report.error().text();
    if (!report) return {};
    const auto again = deck::open(folder_ / "out/deck_0000.rad");
    EXPECT_TRUE(again) << again.error().text();
    if (again) expect_same(again->model, edit_->model);
    return content(folder_ / ("out/" + std::string(file)));
  }
  Error refused() {
    const auto may = can_save(*opened_.deck, opened_.model, edit_->model);
    EXPECT_FALSE(may);
    EXPECT_FALSE(save(*opened_.deck, opened_.model, edit_->model, folder_ / "out/deck_0000.rad"));
    EXPECT_TRUE(std::filesystem::is_empty(folder_ / "out"));
    return may ? Error{} : may.error();
  }
  /// What the check before an edit says; empty: the shell may change between quad and triangle.
  std::string why_no_other_kind(std::int64_t shell) const {
    const auto may = KindCheck(*opened_.deck, opened_.model).may_change_kind(opened_.model.find_shell(shell));
    return may ? "" : may.error().message;
  }
  void divide_11() { edit_->split_in_four(edit_->shell(edit_->shell(11).valid() ? 11 : 211)); }
  /// A quad becomes two triangles.
  void cut(std::int64_t shell) {
    const auto n = edit_->model.shell(edit_->shell(shell)).node;
    set_shell_nodes(edit_->model, edit_->shell(shell), {{n[0], n[1], n[2], n[2]}});
    edit_->child(edit_->shell(shell), n[0], n[2], n[3], n[3]);
  }

  OpenedDeck opened_;
  std::optional<Growing> edit_;
};

TEST_F(RadiossWriting, new_cards_stand_behind_those_they_come_from) {
  const std::string head(kHead), old_head = "#RADIOSS STARTER\n/BEGIN\nold\n      44       0\n";
  edit(head + six_nodes() + two_quads() + kPart + "/END\n");
  divide_11();
  EXPECT_EQ(written(), head + eleven_nodes() + five_quads() + kPart + "/END\n");
  edit(with_crlf(head + six_nodes() + two_quads() + kPart + "/END\n"));
  divide_11();
  EXPECT_EQ(written(), with_crlf(head + eleven_nodes() + five_quads() + kPart + "/END\n"));
  edit(old_head + six_nodes(8) + two_quads(8) + "/END\n");
  divide_11();
  EXPECT_EQ(written(), old_head + eleven_nodes(8) + five_quads(8) + "/END\n");
}

TEST_F(RadiossWriting, ids_and_lengths_of_a_submodel_are_its_own) {
  const std::string before = std::string(kHead) + "/UNIT/3\nmetres\n" + reals({"kg", "m", "s"}) + "\n//SUBMODEL/5/3\nsub\n" +
                             card({1000, 100, 200, 300, 400, 500});
  const std::string after = "//ENDSUB\n/GRNOD/NODE/1\nset\n" + card({102, 101}) + "/END\n";
  const Growing& growing = edit(before + six_nodes() + two_quads() + after);
  EXPECT_EQ(position_of(growing.model, 102), Vec3(1000, 0, 0));
  divide_11();
  EXPECT_EQ(growing.model.find_node(107).valid() && growing.model.find_shell(213).valid(), true);
  EXPECT_EQ(written(), before + eleven_nodes() + five_quads() + "//ENDSUB\n/GRNOD/NODE/1\nset\n" + card({102, 101, 107}) + "/END\n");
}

TEST_F(RadiossWriting, of_a_submodel_lists_that_would_change_are_refused) {
  const std::string before = std::string(kHead) + "//SUBMODEL/5\nsub\n" + card({1000, 100, 200, 300, 400, 500}) + six_nodes() + two_quads();
  edit(before + "/GRNOD/NODE/1\nset\n" + card({1, 2}) + "//ENDSUB\n/END\n");
  divide_11();
  const Error error = refused();
  EXPECT_EQ(error.message, "GRNOD/NODE 1001 stands in a submodel that adds to its ids, so its list can't be changed; nothing was written");
  EXPECT_EQ(error.line, 20);
}

struct GroupCase {
  const char* what;
  std::string before, after;
};

TEST_F(RadiossWriting, what_all_come_from_is_in_the_new_ones_join) {
  const GroupCase cases[] = {
      {"both ends", "/GRNOD/NODE/1\nset\n" + card({1, 2}), "/GRNOD/NODE/1\nset\n" + card({1, 2, 7})},
      {"one end isn't enough", "/GRNOD/NODE/1\nset\n" + card({1, 3}), "/GRNOD/NODE/1\nset\n" + card({1, 3})},
      {"all corners", "/GRNOD/NODENS/1\nset\n" + card({1, 2, 4, 5}), "/GRNOD/NODENS/1\nset\n" + card({1, 2, 4, 5, 7, 8, 9, 10, 11})},
      {"a full line", "/GRNOD/NODE/1\nset\n" + card({1, 2, 21, 22, 23, 24, 25, 26, 27, 28}) + "# behind\n",
       "/GRNOD/NODE/1\nset\n" + card({1, 2, 21, 22, 23, 24, 25, 26, 27, 28}) + card({7}) + "# behind\n"},
      {"comments and blank lines stay", "/GRNOD/NODE/1\n# title\nset\n# list\n\n" + card({1, 2}) + "\n# behind\n",
       "/GRNOD/NODE/1\n# title\nset\n# list\n\n" + card({1, 2, 7}) + "\n# behind\n"},
      {"beside one that is taken away", "/GRNOD/NODE/1\nset\n" + card({1, 2, -4}), "/GRNOD/NODE/1\nset\n" + card({1, 2, -4, 7})},
      {"a parameter stays",
       "/PARAMETER/GLOBAL/INTEGER/1\none\nn                          1\n/GRNOD/NODE/1\nset\n" + right("&n", 10) + card({2}),
       "/PARAMETER/GLOBAL/INTEGER/1\none\nn                          1\n/GRNOD/NODE/1\nset\n" + right("&n", 10) + card({2, 7})},
      {"a range that is full", "/GRNOD/GENE/1\nrange\n" + card({1, 6}), "/GRNOD/GENE/1\nrange\n" + card({1, 6}) + card({7, 11})},
      {"a range with room", "/GRNOD/GENE/1\nrange\n" + card({1, 50}), "/GRNOD/GENE/1\nrange\n" + card({1, 50})},
      {"a range with steps", "/GRNOD/GEN_INCR/1\nsteps\n" + card({1, 2, 1}),
       "/GRNOD/GEN_INCR/1\nsteps\n" + card({1, 2, 1}) + card({7, 7, 1})},
      {"a range of shells", "/GRSHEL/GENE/1\nrange\n" + card({11, 12}), "/GRSHEL/GENE/1\nrange\n" + card({11, 12}) + card({13, 15})},
      {"shells", "/GRSHEL/SHEL/1\nset\n" + card({11}), "/GRSHEL/SHEL/1\nset\n" + card({11, 13, 14, 15})},
      {"other shells", "/GRSHEL/SHELL/1\nset\n" + card({12}), "/GRSHEL/SHELL/1\nset\n" + card({12})},
      {"parts", "/GRNOD/PART/1\nset\n" + card({1}), "/GRNOD/PART/1\nset\n" + card({1})},
      {"histories and bodies", "/TH/SHEL/1\nhistory\nDEF\n" + card({11}) + "/RBODY/2\nbody\n" + card({1, 0, 0, 0, 5}),
       "/TH/SHEL/1\nhistory\nDEF\n" + card({11}) + "/RBODY/2\nbody\n" + card({1, 0, 0, 0, 5})},
      {"segments", "/SURF/SEG/1\nsurface\n" + card({3, 1, 2, 5, 4}) + card({9, 2, 3, 6, 5}),
       "/SURF/SEG/1\nsurface\n" + card({3, 1, 7, 11, 10}) + card({10, 7, 2, 8, 11}) + card({11, 11, 8, 5, 9}) + card({12, 10, 11, 9, 4}) +
           card({9, 2, 3, 6, 5})},
      {"lines", "/LINE/SEG/1\nline\n" + card({1, 1, 2}), "/LINE/SEG/1\nline\n" + card({1, 1, 2})},
  };
  for (const GroupCase& c : cases) {
    SCOPED_TRACE(c.what);
    edit(std::string(kHead) + six_nodes() + two_quads() + c.before + "/END\n");
    divide_11();
    EXPECT_EQ(written(), std::string(kHead) + eleven_nodes() + five_quads() + c.after + "/END\n");
  }
}

TEST_F(RadiossWriting, what_goes_leaves_its_lists) {
  const std::string kept_nodes =
      "/NODE\n" + node(1, "0", "0", "0") + node(2, "1", "0", "0") + node(4, "0", "1", "0") + node(5, "1", "1", "0");
  const GroupCase cases[] = {
      {"nodes", "/GRNOD/NODE/1\nset\n" + card({3, 1, 6, 2}), "/GRNOD/NODE/1\nset\n" + card({1, 2})},
      {"a line of its own", "/GRNOD/NODE/1\nset\n" + card({3, 6}) + card({1}), "/GRNOD/NODE/1\nset\n" + card({1})},
      {"an id that is named twice", "/GRNOD/NODE/1\nset\n" + card({3, 1, 3}) + card({3, 2}),
       "/GRNOD/NODE/1\nset\n" + card({1}) + card({2})},
      {"shells", "/GRSHEL/SHEL/1\nset\n" + card({11, 12}), "/GRSHEL/SHEL/1\nset\n" + card({11})},
      {"segments", "/SURF/SEG/1\nsurface\n" + card({1, 2, 3, 6, 5}) + card({2, 1, 2, 5, 4}),
       "/SURF/SEG/1\nsurface\n" + card({2, 1, 2, 5, 4})},
  };
  for (const GroupCase& c : cases)
    for (const bool crlf : {false, true}) {
      SCOPED_TRACE(c.what);
      const auto ended = [&](const std::string& text) { return crlf ? with_crlf(text) : text; };
      Growing& growing = edit(ended(std::string(kHead) + six_nodes() + two_quads() + c.before));
      remove_shell(growing.model, growing.shell(12));
      remove_node(growing.model, growing.node(3));
      remove_node(growing.model, growing.node(6));
      EXPECT_EQ(written(), ended(std::string(kHead) + kept_nodes + "/SHELL/1\n" + card({11, 1, 2, 5, 4}) + c.after));
    }
}

TEST_F(RadiossWriting, what_cant_leave_its_list_is_refused_with_the_place) {
  const std::string by_parameter = "/PARAMETER/GLOBAL/INTEGER/1\nthree\nn                          3\n/GRNOD/NODE/1\nset\n";
  const std::string hidden =
      "GRNOD/NODE 1 names one of them by a parameter or in an include, so it can't be taken out; nothing was written";
  struct Case {
    std::string cards, message;
    long line;
  };
  const Case cases[] = {
      {"/GRNOD/NODE/1\nset\n" + card({3}) + card({6}), "GRNOD/NODE 1 would be left without any; nothing was written", 17},
      {by_parameter + right("&n", 10) + card({1, 6}), hidden, 20},
      {by_parameter + right("&n", 10) + card({1, 6, 6}), hidden, 20},
      {"/GRNOD/NODE/1\nset\n" + card({1}) + "#include list.inc\n", hidden, 17},
      {"/GRNOD/NODE/1\n#include titled.inc\n", "GRNOD/NODE 1 has no title, so its list can't be found; nothing was written", 17},
      {"/RBODY/1\nbody\n" + card({3}), "node 3 can't be removed: RBODY 1 names it; nothing was written", 19},
      {"/GRNOD/NODE/1\nset\n" + card({1, -3}), "node 3 can't be removed: GRNOD/NODE 1 names it; nothing was written", 19},
  };
  folder_.write("list.inc", card({3, 6}));
  folder_.write("titled.inc", "set\n" + card({1, 3, 6}));
  for (const Case& c : cases) {
    SCOPED_TRACE(c.cards);
    Growing& growing = edit(std::string(kHead) + six_nodes() + two_quads() + c.cards + "/END\n");
    remove_shell(growing.model, growing.shell(12));
    remove_node(growing.model, growing.node(3));
    remove_node(growing.model, growing.node(6));
    const Error error = refused();
    EXPECT_EQ(error.message, c.message);
    EXPECT_EQ(error.line, c.line);
  }
}

// --- the other kind of block ----------------------------------------------------------------------------------------

/// `corners` of the quad's card with the fourth left blank.
std::string was_quad(std::initializer_list<std::int64_t> corners) {
  const std::string line = card(corners);
  return line.substr(0, line.size() - 1) + std::string(10, ' ') + "\n";
}

TEST_F(RadiossWriting, a_triangle_of_a_quads_block_is_no_example_for_others) {
  const std::string rest = kPart + "/END\n";
  edit(std::string(kHead) + six_nodes() + "/SHELL/1\n" + card({11, 1, 2, 5, 4}) + card({12, 2, 3, 6, 0}) + rest);
  cut(11);
  EXPECT_EQ(written(), std::string(kHead) + six_nodes() + "/SHELL/1\n" + card({12, 2, 3, 6, 0}) + "/SH3N/1\n" + was_quad({11, 1, 2, 5}) +
                           was_quad({13, 1, 5, 4}) + rest);
}

TEST_F(RadiossWriting, triangles_and_quads_go_to_the_block_of_their_kind) {
  const std::string rest = kPart + "/END\n";
  edit(std::string(kHead) + six_nodes() + "/SHELL/1\n" + card({11, 1, 2, 5, 4}) + "/SH3N/1\n" + card({12, 2, 3, 6}) + rest);
  cut(11);
  EXPECT_EQ(written(), std::string(kHead) + six_nodes() + "/SHELL/1\n/SH3N/1\n" + card({12, 2, 3, 6}) + was_quad({11, 1, 2, 5}) +
                           was_quad({13, 1, 5, 4}) + rest);
  // And back: one triangle takes the other's corner.
  const std::string triangles = "/SH3N/1\n" + card({11, 1, 2, 5}) + card({13, 1, 5, 4});
  for (const bool has_quad : {true, false}) {
    const std::string quads = has_quad ? "/SHELL/1\n" + card({12, 2, 3, 6, 5}) : "";
    Growing& growing = edit(std::string(kHead) + six_nodes() + quads + triangles + rest);
    remove_shell(growing.model, growing.shell(13));
    set_shell_nodes(growing.model, growing.shell(11), {{growing.node(1), growing.node(2), growing.node(5), growing.node(4)}});
    EXPECT_EQ(written(), std::string(kHead) + six_nodes() +
                             (has_quad ? quads + card({11, 1, 2, 5, 4}) + "/SH3N/1\n" : "/SH3N/1\n/SHELL/1\n" + card({11, 1, 2, 5, 4})) +
                             rest);
  }
}

/// The cards of both shells after `cut(11)`, and of what stands behind them.
std::string cut_shells(const std::string& behind) {
  return std::string(kHead) + six_nodes() + "/SHELL/1\n" + card({12, 2, 3, 6, 5}) + "/SH3N/1\n" + was_quad({11, 1, 2, 5}) +
         was_quad({13, 1, 5, 4}) + behind + "/END\n";
}
/// A section that uses a group of quads and one of triangles.
std::string section(std::int64_t id, std::int64_t quads, std::int64_t triangles, const std::string& eighth = right("0", 10)) {
  const std::string groups = card({0, 0, quads, 0, 0, 0, triangles});
  return "/SECT/" + std::to_string(id) + "\ncut\n# nodes\n" + card({1, 2, 3, 0}) + "\n# groups\n" + groups.substr(0, 70) + eighth + "\n";
}

TEST_F(RadiossWriting, a_triangle_goes_to_the_group_that_the_same_cards_use) {
  const std::string quads = "/GRSHEL/SHEL/27\n# title\nnear the cut\n" + card({11, 12}) + "# behind\n";
  const std::string kept = "/GRSHEL/SHEL/27\n# title\nnear the cut\n" + card({12});
  const std::string made = "near the cut\n" + card({11, 13}) + "# behind\n";
  const GroupCase cases[] = {
      {"no card uses it", quads, kept + "/GRSH3N/SH3N/27\n" + made},
      {"a section", section(1, 27, 0) + quads, section(1, 27, 27) + kept + "/GRSH3N/SH3N/27\n" + made},
      {"two sections", section(1, 27, 0) + quads + section(2, 27, 0),
       section(1, 27, 27) + kept + "/GRSH3N/SH3N/27\n" + made + section(2, 27, 27)},
      {"a section of others", section(1, 28, 0) + quads, section(1, 28, 0) + kept + "/GRSH3N/SH3N/27\n" + made},
      {"further fields of the section stay", section(1, 27, 0, "         3           4") + quads,
       section(1, 27, 27, "         3           4") + kept + "/GRSH3N/SH3N/27\n" + made},
      {"an activation", "/ACTIV/1\nlate\n" + card({0, 0, 0, 27, 0, 0, 0, 0}) + quads,
       "/ACTIV/1\nlate\n" + card({0, 0, 0, 27, 0, 0, 0, 27}) + kept + "/GRSH3N/SH3N/27\n" + made},
      {"its number is taken", section(1, 27, 0) + "/GRSH3N/PART/27\nother\n" + card({9}) + "/GRSH3N/SH3N/31\nother\n" + card({99}) + quads,
       section(1, 27, 28) + "/GRSH3N/PART/27\nother\n" + card({9}) + "/GRSH3N/SH3N/31\nother\n" + card({99}) + kept + "/GRSH3N/SH3N/28\n" +
           made},
      {"a group of triangles is there", section(1, 27, 5) + quads + "/GRSH3N/SH3N/5\nthree\n" + card({99}),
       section(1, 27, 5) + kept + "# behind\n/GRSH3N/SH3N/5\nthree\n" + card({99, 11, 13})},
      {"a surface of other groups", "/SURF/GRSHEL/1\nsurface\n" + card({26}) + "/SURF/GRSH3N/2\nsurface\n" + card({27}) + quads,
       "/SURF/GRSHEL/1\nsurface\n" + card({26}) + "/SURF/GRSH3N/2\nsurface\n" + card({27}) + kept + "/GRSH3N/SH3N/28\n" + made},
  };
  for (const GroupCase& c : cases)
    for (const bool crlf : {false, true}) {
      SCOPED_TRACE(c.what);
      const auto ended = [&](const std::string& text) { return crlf ? with_crlf(text) : text; };
      edit(ended(std::string(kHead) + six_nodes() + two_quads() + c.before + "/END\n"));
      EXPECT_EQ(why_no_other_kind(11), "");
      cut(11);
      EXPECT_EQ(written(), ended(cut_shells(c.after)));
    }
}

TEST_F(RadiossWriting, where_the_cards_that_use_a_group_cant_use_one_of_triangles_it_is_refused) {
  const std::string quads = "/GRSHEL/SHEL/27\nnear the cut\n" + card({11, 12});
  struct Case {
    std::string cards, why;
  };
  const Case cases[] = {
      {quads + "/SURF/GRSHEL/1\nsurface\n" + card({26, 27}),
       ", and SURF/GRSHEL 1 uses it, which can't use a group of the other kind as well"},
      {quads + "/GRNOD/GRSHEL/1\nnodes\n" + card({27}), ", and GRNOD/GRSHEL 1 uses it, which can't use a group of the other kind as well"},
      {quads + section(1, 27, 0) + section(2, 27, 5), ", and is used with different groups of the other kind"},
      {quads + section(1, 27, 5) + section(2, 28, 5) + "/GRSH3N/SH3N/5\nthree\n" + card({99}),
       ", and the group that is used with it, GRSH3N 5, is used elsewhere or isn't a list"},
      {quads + section(1, 27, 5) + "/GRSH3N/PART/5\nthree\n" + card({1}),
       ", and the group that is used with it, GRSH3N 5, is used elsewhere or isn't a list"},
      {quads + quads, ", and another group has its number"},
      {quads + "/SECT/3\ncut\n" + card({1, 2, 3}), ", and SECT 3, which may use it, isn't complete in its file"},
      {quads + "/SECT/1\ncut\n" + card({1, 2, 3, 0}) + "\n" + right("0", 20) + right("&n", 10) + card({0, 0, 0, 0}),
       ", and SECT 1 names its groups by parameters"},
      {"/GRSHEL/GENE/27\nrange\n" + card({11, 12}), ""},
      {"/TH/SHEL/27\nhistory\nDEF\n" + card({11}), ""},
      {quads + "/UNKNOWN/1\n" + card({27}), ", and UNKNOWN isn't read in this version, and may name it"},
      {quads + "#include gone.inc\n", ", and goes on in an include"},
      {quads + "/TITLE\n#include gone.inc\n", ", and the include file gone.inc isn't there, and may use it"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.cards);
    edit(std::string(kHead) + six_nodes() + two_quads() + c.cards + "/END\n");
    cut(11);
    const std::string namer = c.cards.substr(1, c.cards.find("/27") - 1);
    EXPECT_EQ(why_no_other_kind(11), "shell 11 can't become a triangle: " + namer + " 27 names it, which can't name one" + c.why);
    EXPECT_EQ(refused().message,
              "shell 11 becomes a triangle, but " + namer + " 27 names it, which can't name one" + c.why + "; nothing was written");
  }
}

TEST_F(RadiossWriting, a_new_block_stands_where_it_is_read) {
  folder_.write("shells.inc", two_quads() + "#enddata\nwhat isn't read\n/SHELL/1\n");
  edit(std::string(kHead) + six_nodes() + "#include shells.inc\n" + kPart + "/END\n");
  cut(11);
  EXPECT_EQ(written("shells.inc"), "/SHELL/1\n" + card({12, 2, 3, 6, 5}) + "/SH3N/1\n" + was_quad({11, 1, 2, 5}) + was_quad({13, 1, 5, 4}) +
                                       "#enddata\nwhat isn't read\n/SHELL/1\n");
}

TEST_F(RadiossWriting, where_no_block_of_the_other_kind_can_stand_it_is_refused) {
  const std::string interrupted = "stands in a block that an include interrupts", going_on = "stands in a block that goes on in an include";
  const std::string lost = "has no keyword that could be found";
  struct Case {
    const char* what;
    std::string shells, file, why;
    long line;
  };
  const Case cases[] = {
      {"behind an include", "/SHELL/1\n" + card({12, 2, 3, 6, 5}) + "#include more.inc\n" + card({11, 1, 2, 5, 4}), "deck_0000.rad",
       interrupted, 17},
      {"in any letters", "/SHELL/2\n" + card({12, 2, 3, 6, 5}) + "#INCLUDE keyword.inc\n" + card({11, 1, 2, 5, 4}), "deck_0000.rad",
       interrupted, 17},
      {"before an include", "/SHELL/1\n" + card({11, 1, 2, 5, 4}) + "#include more.inc\n", "deck_0000.rad", going_on, 15},
      {"before one in any letters", "/SHELL/1\n" + card({11, 1, 2, 5, 4}) + "#Include more.inc\n", "deck_0000.rad", going_on, 15},
      {"of no part", "/SHELL\n" + card({11, 1, 2, 5, 4}), "deck_0000.rad", lost, 15},
      {"in a file of cards alone", "/SHELL/1\n#include cards.inc\n", "cards.inc", lost, 2},
  };
  folder_.write("more.inc", card({21, 2, 3, 6, 5}));
  folder_.write("keyword.inc", "/SHELL/1\n" + card({21, 2, 3, 6, 5}));
  folder_.write("cards.inc", "# made 2/12/2020\n" + card({11, 1, 2, 5, 4}));
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    edit(std::string(kHead) + six_nodes() + c.shells + "/END\n");
    cut(11);
    const Error error = refused();
    EXPECT_EQ(error.message, "shell 11 becomes a triangle and " + c.why + "; nothing was written");
    EXPECT_EQ(why_no_other_kind(11), "shell 11 can't become a triangle: it " + c.why);
    EXPECT_EQ(std::filesystem::path(error.file).filename(), c.file);
    EXPECT_EQ(error.line, c.line);
  }
}

TEST_F(RadiossWriting, ids_that_a_parameter_gives_arent_changed) {
  edit(std::string(kHead) + "/PARAMETER/GLOBAL/INTEGER/1\none\nn                          1\n" + six_nodes() + "/SHELL/1\n" +
       right("11", 10) + right("&n", 10) + card({2, 5, 4}) + "/END\n");
  divide_11();
  const Error error = refused();
  EXPECT_EQ(error.message, "shell 11 has ids given by a parameter, which can't be changed here; nothing was written");
  EXPECT_EQ(error.line, 18);
}

// --- the writer by itself -------------------------------------------------------------------------------------------

constexpr std::array<std::array<double, 4>, 4> kOwnCorners{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

TEST(RadiossWriter, moves_within_the_columns) {
  struct Case {
    const char* what;
    std::uint16_t style;
    std::string before;
    Vec3 from, to;
    std::string after;
  };
  const Case cases[] = {
      {"the field that changes",
       0,
       right("1", 10) + reals({"1.000", "2", "3."}) + " behind",
       {1, 2, 3},
       {1, -2.5, 3},
       right("1", 10) + reals({"1.000", "-2.5", "3."}) + " behind"},
      {"leaning left",
       0,
       "1         1.0                 2.0                 3.0                 ",
       {1, 2, 3},
       {1, 2, 4.25},
       "1         1.0                 2.0                 4.25                "},
      {"leaning left behind a blank",
       0,
       "1          1.0                 2.0                3.0                ",
       {1, 2, 3},
       {1.5, 2, 3},
       "1          1.5                 2.0                3.0                "},
      {"a short line", 0, right("1", 10) + reals({"1.0"}), {1, 0, 0}, {1, 0, 2}, right("1", 10) + reals({"1.0", "", "2.0"})},
      {"tabs count as one blank",
       0,
       "1\t\t\t\t\t\t\t\t\t" + reals({"1.0", "2.0", "3.0"}),
       {1, 2, 3},
       {1, 2, 9},
       "1         " + reals({"1.0", "2.0", "9.0"})},
      {"old columns",
       1,
       right("1", 8) + reals({"1.0", "2.0", "3.0"}, 16),
       {1, 2, 3},
       {1, 1.0 / 3, 3},
       right("1", 8) + reals({"1.0", ".333333333333333", "3.0"}, 16)},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    const std::string text = c.before + "\r\n/END\n";
    EXPECT_EQ(kStarterWriter->node_end({text, 0, c.style}), c.before.size());
    EXPECT_EQ(kStarterWriter->node_coordinates({text, 0, c.style}), c.from);
    const WrittenCard card = kStarterWriter->move_node({text, 0, c.style}, c.from, c.to);
    EXPECT_EQ(card.text, c.after);
    EXPECT_FALSE(card.by_parameter);
    EXPECT_EQ(card.rounded, c.style == 1 ? 1 : 0);
  }
  const std::string by_parameter = right("1", 10) + reals({"&x", "2.0", "3.0"});
  EXPECT_EQ(kStarterWriter->node_coordinates({by_parameter, 0, 0}), std::nullopt);
  EXPECT_TRUE(kStarterWriter->move_node({by_parameter, 0, 0}, {1, 2, 3}, {2, 2, 3}).by_parameter);
  EXPECT_FALSE(kStarterWriter->move_node({by_parameter, 0, 0}, {1, 2, 3}, {1, 2, 4}).by_parameter);
}

TEST(RadiossWriter, tells_the_largest_id_of_each_layout) {
  EXPECT_EQ(kStarterWriter->largest_node_id(0), 9'999'999'999);
  EXPECT_EQ(kStarterWriter->largest_shell_id(kTriangle), 9'999'999'999);
  EXPECT_EQ(kStarterWriter->largest_node_id(1), 99'999'999);
  EXPECT_EQ(kStarterWriter->largest_shell_id(kOldQuad), 99'999'999);
}

TEST(RadiossWriter, writes_ids_of_ten_and_eight_digits) {
  const ShellCard ten{9876543210, {1234567890, 1234567891, 1234567892, 1234567893}, kOwnCorners, 0};
  const auto same = kStarterWriter->shell({"0000000011         1         2         5         4", 0, 0}, {11, {1, 2, 5, 7}, kOwnCorners, 0});
  ASSERT_TRUE(same);
  EXPECT_EQ(same->text, "0000000011         1         2         5         7") << "an id that stays keeps its digits";
  const auto quad = kStarterWriter->shell({card({11, 1, 2, 5, 4}), 0, 0}, ten);
  ASSERT_TRUE(quad);
  EXPECT_EQ(quad->text, "98765432101234567890123456789112345678921234567893");
  const ShellCard eight{98765432, {12345670, 12345671, 12345672, 12345672}, kOwnCorners, 0};
  const auto triangle = kStarterWriter->shell({card({11, 1, 2, 5}, 8), 0, kOldQuad | kTriangle}, eight);
  ASSERT_TRUE(triangle);
  EXPECT_EQ(triangle->text, "98765432123456701234567112345672");
  EXPECT_EQ(kStarterWriter->new_node({"", 0, 0}, 9876543210, Vec3(0, 0, 1)).text, "9876543210" + reals({"0.0", "0.0", "1.0"}));
}

TEST(RadiossWriter, refuses_shells_of_another_kind_or_width) {
  const std::string quads = card({11, 1, 2, 5, 4}), triangles = card({12, 2, 3, 6});
  const ShellCard quad{11, {1, 2, 5, 4}, kOwnCorners, 0}, triangle{11, {1, 2, 5, 5}, kOwnCorners, 0};
  const auto why = [](const Result<WrittenCard>& card) { return card ? std::string() : card.error().message; };
  EXPECT_EQ(why(kStarterWriter->shell({quads, 0, 0}, triangle)), "stands in a /SHELL block, where a triangle's own block is /SH3N");
  EXPECT_EQ(why(kStarterWriter->shell({triangles, 0, kTriangle}, quad)), "stands in an /SH3N block, which holds triangles only");
  EXPECT_EQ(why(kStarterWriter->shell_in_manner({quads, 0, 0}, {quads, 0, 0}, triangle)),
            "has another number of corners than the block it would go to");
  EXPECT_EQ(why(kStarterWriter->shell_in_manner({quads, 0, 0}, {triangles, 0, kTriangle | kOldQuad}, triangle)),
            "would go to a block with columns of another width");
  EXPECT_EQ(why(kStarterWriter->shell_in_manner({quads, 0, 0}, {triangles, 0, kTriangle}, triangle)), "");
}

TEST(RadiossWriter, tells_which_cards_name_one_kind_only) {
  const auto names = [](const char* keyword) {
    Referrer card;
    card.keyword = keyword;
    return std::pair(kStarterWriter->can_name(card, false), kStarterWriter->can_name(card, true));
  };
  for (const char* quads : {"GRSHEL/SHEL", "GRSHEL/GENE", "TH/SHEL"}) EXPECT_EQ(names(quads), std::pair(true, false)) << quads;
  for (const char* triangles : {"GRSH3N/SH3N", "TH/SH3N"}) EXPECT_EQ(names(triangles), std::pair(false, true)) << triangles;
  for (const char* both : {"GRNOD/NODE", "SURF/SEG", "TH/PART"}) EXPECT_EQ(names(both), std::pair(true, true)) << both;
  Referrer group, history;
  group.keyword = "GRNOD/NODE";
  history.keyword = "TH/NODE";
  EXPECT_EQ(kStarterWriter->inheritance(group, Referred::node), Inheritance::forbids);
  EXPECT_EQ(kStarterWriter->inheritance(history, Referred::node), Inheritance::stays);
}

using Segments = std::vector<std::array<std::int64_t, 4>>;

/// A surface of one segment, in a deck of its own.
class RadiossSegments : public Radioss {
 protected:
  void open_with(const std::string& text) {
    auto opened = open(text);
    if (!opened) throw std::runtime_error(opened.error().text());
    deck_ = opened->deck;
  }
  std::string_view text() const { return deck_->files[0].bytes.text(); }
  const Referrer& surface() const { return deck_->references->referrers().front(); }
  std::string refused(const Segments& with) const {
    const auto changed = kStarterWriter->replace_segment(text(), surface(), deck_->references->all().front().card, with);
    return changed ? "" : changed.error().message;
  }

  std::shared_ptr<const Deck> deck_;
};

TEST_F(RadiossSegments, are_replaced_in_their_columns) {
  struct Case {
    const char* what;
    std::string head, title, line;
    std::array<std::int64_t, 4> corners;
    Segments with;
    std::string after;
  };
  const std::string head(kHead), old = "#RADIOSS STARTER\n/BEGIN\nold\n      44       0\n";
  const std::string named = "/SURF/SEG/2\n2022\n";
  const Case cases[] = {
      {"divided",
       head,
       named,
       card({7, 1, 2, 3, 4}),
       {1, 2, 3, 4},
       {{1, 2, 9, 9}, {2, 3, 4, 9}},
       card({7, 1, 2, 9, 9}) + card({8, 2, 3, 4, 9})},
      {"a triangle", head, named, card({7, 1, 2, 3}), {1, 2, 3, 3}, {{1, 2, 9, 9}}, card({7, 1, 2, 9, 9})},
      {"a triangle with a zero", head, named, card({7, 1, 2, 3, 0}), {1, 2, 3, 3}, {{1, 2, 9, 9}}, card({7, 1, 2, 9, 9})},
      {"old columns", old, named, card({7, 1, 2, 3, 4}, 8), {1, 2, 3, 4}, {{1, 2, 12345678, 4}}, card({7, 1, 2, 12345678, 4}, 8)},
      {"gone", head, named + card({6, 2, 3, 4, 4}), card({7, 1, 2, 3, 4}), {1, 2, 3, 4}, {}, ""},
  };
  for (const Case& c : cases)
    for (const bool crlf : {false, true}) {
      SCOPED_TRACE(c.what);
      const auto ended = [&](const std::string& text) { return crlf ? with_crlf(text) : text; };
      open_with(ended(c.head + c.title + c.line + "/END\n"));
      const std::size_t at = text().find(ended(c.line));
      EXPECT_EQ(kStarterWriter->segment(text(), surface(), at), c.corners);
      const auto changed = kStarterWriter->replace_segment(text(), surface(), at, c.with);
      ASSERT_TRUE(changed);
      ASSERT_EQ(changed->size(), 1u);
      std::string out(text());
      out.replace(changed->front().offset, changed->front().length, changed->front().text);
      EXPECT_EQ(out, ended(c.head + c.title + c.after + "/END\n"));
    }
}

TEST_F(RadiossSegments, that_cant_be_written_say_why) {
  const std::string head(kHead), old = "#RADIOSS STARTER\n/BEGIN\nold\n      44       0\n";
  const Segments one = {{1, 2, 9, 9}}, two = {{1, 2, 9, 9}, {2, 3, 4, 9}};
  open_with(head + "//SUBMODEL/1\ns\n" + card({0, 100}) + "/SURF/SEG/2\nsurface\n" + card({7, 1, 2, 3, 4}) + "//ENDSUB\n/END\n");
  EXPECT_EQ(refused(one), "stands in a submodel that adds to its ids, so its segments can't be changed");
  EXPECT_EQ(kStarterWriter->segment(text(), surface(), text().find(card({7, 1, 2, 3, 4}))), std::nullopt);
  open_with(head + "/LINE/SEG/2\nline\n" + card({7, 1, 2}) + "/END\n");
  EXPECT_EQ(refused(one), "is a line, whose segments can't be divided");
  EXPECT_EQ(kStarterWriter->segment(text(), surface(), text().find(card({7, 1, 2}))), std::nullopt);
  open_with(head + "/SURF/SEG/2\nsurface\n" + card({9999999999, 1, 2, 3, 4}) + "/END\n");
  EXPECT_EQ(refused(one), "");
  EXPECT_EQ(refused(two), "has no room for the number of one more segment");
  EXPECT_EQ(refused({{1, 2, 3, 10000000000}}), "has fields that are too narrow for the new id");
  open_with(old + "/SURF/SEG/2\nsurface\n" + card({7, 1, 2, 3, 4}, 8) + "/END\n");
  EXPECT_EQ(refused({{1, 2, 3, 100000000}}), "has fields that are too narrow for the new id");
  EXPECT_EQ(refused({{1, 2, 3, 99999999}}), "");
}

TEST_F(RadiossSegments, and_lists_take_what_comes_and_goes_at_once) {
  const std::string groups = std::string(kHead) + "/GRNOD/NODE/1\nset\n" + card({1}) + card({3});
  open_with(groups + "/END\n");
  const auto changed = kStarterWriter->change_list(text(), surface(), std::array<std::int64_t, 1>{7}, std::array<std::int64_t, 1>{3});
  ASSERT_TRUE(changed);
  std::string out(text());
  for (auto r = changed->rbegin(); r != changed->rend(); ++r) out.replace(r->offset, r->length, r->text);
  EXPECT_EQ(out, std::string(kHead) + "/GRNOD/NODE/1\nset\n" + card({1, 7}) + "/END\n");
  open_with(std::string(kHead) + "/GRNOD/GENE/1\nset\n" + card({1, 6}) + "/END\n");
  const auto ranges = kStarterWriter->join(text(), surface(), std::array<std::int64_t, 4>{7, 8, 10, 12});
  ASSERT_TRUE(ranges);
  EXPECT_EQ((*ranges)[0].text + "\n", "\n" + card({7, 8}) + card({10, 10}) + card({12, 12}));
}

TEST_F(RadiossSegments, and_lists_of_old_versions_take_eight_digits) {
  const auto joined = [&](const std::string& text_of_deck, std::int64_t id) {
    open_with(text_of_deck);
    const auto changed = kStarterWriter->join(text(), surface(), std::array<std::int64_t, 1>{id});
    return changed ? changed->front().text : changed.error().message;
  };
  const std::string narrow = "has fields that are too narrow for the new id";
  const std::string old = "#RADIOSS STARTER\n/BEGIN\nold\n      44       0\n/GRNOD/NODE/1\nset\n" + card({1}, 8) + "/END\n";
  const std::string ours = std::string(kHead) + "/GRNOD/NODE/1\nset\n" + card({1}) + "/END\n";
  EXPECT_EQ(joined(old, 99999999), right("1", 8) + "99999999");
  EXPECT_EQ(joined(old, 100000000), narrow);
  EXPECT_EQ(joined(ours, 9999999999), right("1", 10) + "9999999999");
  EXPECT_EQ(joined(ours, 10000000000), narrow);
  EXPECT_EQ(joined(std::string(kHead) + "/GRNOD/GENE/1\nset\n" + card({1, 6}) + "/END\n", 10000000000), narrow);
}

}  // namespace
}  // namespace prismesh::mesh::deck
