// What the reader of bulk data warns of: the sentence and the line it names.
#include "mesh/deck/nastran/card.h"
#include "mesh/deck/open.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

const std::string kFourGrids = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nGRID,5,,.5,.5,0.\n";

struct Warned {
  std::string text;
  const char* kind;
  long line;
  const char* message;
};

TEST(NastranWarnings, name_the_line_and_what_is_odd_there) {
  const Warned cases[] = {
      {"BEGIN BULK\n+,7\nGRID,1\nENDDATA\n", "stray-continuation", 2, "a continuation follows no card; it is kept but means nothing"},
      {"GRID,1\nSPC1           7     123       1       1       1       1       1       1+A\n+B             1\n", "continuation-order", 3,
       "a continuation of the SPC1 card has another name than the line before asks for; it is taken to belong there all the same"},
      {"GRID,1\nSPC1,7,123,1,1,1,1,1,1,+,9,9\n", "long-card", 2,
       "the SPC1 card has more fields than a card can have; the last ones aren't read"},
      {kFourGrids + "CQUAD4,1,1,1,2,3,4,0.,0.,+,9\n", "long-card", 6,
       "the CQUAD4 card has more fields than a card can have; the last ones aren't read"},
      {kFourGrids + "CQUAD,1,1,1,2,3,4\n,,,5\n", "centre-node", 6, "the centre nodes of CQUAD elements aren't moved along with them"},
      {"GRID,1\nCORD2R,5,0,a,0.,0.,0.,0.,1.\n,1.,0.,0.\n", "bad-coordinate-system", 2,
       "a coordinate system has something that is no number; it is left out"},
      {"GRID,1\nGRDSET,,0\nGRDSET,,0\n", "duplicate-grdset", 3, "there is more than one GRDSET; the first counts"},
      {"GRID,1\nCORD2R,5,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,5,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n", "duplicate-coordinate-system", 4,
       "coordinate system 5 is defined again; its first definition counts"},
      {"CEND\nBEGIN BULK\nGRID,1\nBEGIN SUPER=1\nGRID,1\n", "no-end", 6,
       "the deck has BEGIN BULK but no ENDDATA: it may have been cut off"},
      {"SOL 101\nCEND\nTITLE = GRID\n", "no-bulk-data", 1,
       "the deck has executive or case control but no BEGIN BULK: there is nothing to show"},
  };
  const DeckFolder folder;
  for (const Warned& wanted : cases) {
    SCOPED_TRACE(wanted.text);
    const auto opened = deck::open(folder.write("deck.bdf", wanted.text));
    ASSERT_OPENED(opened);
    const Warning found = warning(*opened->deck, wanted.kind);
    EXPECT_EQ(found.count, 1u);
    EXPECT_EQ(found.line, wanted.line);
    EXPECT_EQ(found.message, wanted.message);
    EXPECT_EQ(found.file, (folder / "deck.bdf").string());
  }
}

TEST(NastranWarnings, of_what_is_defined_again_the_first_counts) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "GRID,1,,2.,90.,5.\nGRID,2,3,1.,0.,0.\nGRDSET,,1\nGRDSET,,0\nCORD2C,1,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
      "CORD2R,3,0,7.,0.,0.,7.,0.,1.\n,8.,0.,0.\nCORD2R,3,0,9.,0.,0.,9.,0.,1.\n,10.,0.,0.\n");
  ASSERT_OPENED(opened);
  EXPECT_LT((position_of(opened->model, 1) - Vec3(0, 2, 5)).norm(), 1e-12);
  EXPECT_EQ(position_of(opened->model, 2), Vec3(8, 0, 0));
}

TEST(NastranWarnings, enddata_ends_an_include_alone) {
  const DeckFolder folder;
  folder.write("part.bdf", "GRID,2,,2.\nENDDATA\nGRID,3,,3.\n");
  const auto opened = folder.open("BEGIN BULK\nGRID,1,,1.\nINCLUDE 'part.bdf'\nGRID,4,,4.\nENDDATA\nGRID,5,,5.\n");
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->model.node_count(), 3u);
  EXPECT_EQ(position_of(opened->model, 4), Vec3(4, 0, 0));
  EXPECT_FALSE(opened->model.find_node(3).valid());
  EXPECT_EQ(warning(*opened->deck, "end-in-include").line, 2);
  EXPECT_EQ(warning(*opened->deck, "end-in-include").file, (folder / "part.bdf").string());
  EXPECT_EQ(warning(*opened->deck, "end-in-include").message, "ENDDATA in an include is taken to end that file only");
  EXPECT_EQ(warning(*opened->deck, "no-end").count, 0u);
}

/// 64 files may stand in each other below the main one.
TEST(NastranWarnings, includes_nest_only_so_deep) {
  const DeckFolder folder;
  const auto name = [](int depth) { return "f" + std::to_string(depth) + ".bdf"; };
  for (int depth = 1; depth <= 65; ++depth)
    folder.write(name(depth), "GRID," + std::to_string(depth) + "\nINCLUDE '" + name(depth + 1) + "'\n");
  folder.write(name(66), "GRID,66\n");
  const auto opened = folder.open("INCLUDE 'f1.bdf'\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 64u);
  const Warning deep = warning(*opened->deck, "deep-include");
  EXPECT_EQ(deep.count, 1u);
  EXPECT_EQ(deep.line, 2);
  EXPECT_EQ(deep.file, (folder / "f64.bdf").string());
  EXPECT_EQ(deep.message, "the include file f65.bdf is nested more than 64 deep; it isn't read");
}

TEST(NastranWarnings, an_include_is_looked_for_beside_its_file_and_then_beside_the_main_one) {
  const DeckFolder folder;
  folder.write("sub/a.bdf", "GRID,2\nINCLUDE 'b.bdf'\nINCLUDE 'c.bdf'\n");
  folder.write("sub/b.bdf", "GRID,3,,3.\n");
  folder.write("b.bdf", "GRID,3,,9.\n");
  folder.write("c.bdf", "GRID,4,,4.\n");
  const auto opened = folder.open("GRID,1\nINCLUDE 'sub/a.bdf'\n");
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->model.node_count(), 4u);
  EXPECT_EQ(position_of(opened->model, 3), Vec3(3, 0, 0));
  EXPECT_TRUE(opened->deck->warnings.empty());
}

TEST(NastranWarnings, begin_bulk_of_a_superelement_is_another_section) {
  const DeckFolder folder;
  const auto opened = folder.open("CEND\nBEGIN BULK $ all\nGRID,1\nBEGIN BULK SUPER=1\nGRID,2\nENDDATA\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 1u);
  EXPECT_EQ(warning(*opened->deck, "unread-section").line, 4);
}

TEST(NastranScalarPoints, are_left_out_of_ranges_and_lists) {
  const DeckFolder folder;
  const auto named = [&](const std::string& cards, std::initializer_list<std::int64_t> ids) {
    const auto opened = folder.open(kFourGrids + "GRID,7\n" + cards);
    EXPECT_TRUE(opened) << opened.error().text();
    std::string out;
    if (!opened) return out;
    for (const std::int64_t id : ids) out += opened->deck->references->named(Referred::node, id) ? "y" : "n";
    return out;
  };
  EXPECT_EQ(named("SPOINT,101,THRU,102\nSPOINT,103,THRU,105\nSPC1,1,0,101,THRU,105\n", {101, 103, 105}), "nnn") << "ranges that touch";
  EXPECT_EQ(named("SPOINT,101,THRU,109\nSPOINT,103,104\nSPC1,1,0,101,THRU,109\n", {101, 103, 108}), "nnn") << "one within another";
  EXPECT_EQ(named("SPOINT,6\nSPC1,1,0,5,6,7\n", {4, 5, 6, 7, 8}), "nynyn");
  EXPECT_EQ(named("SPOINT,6\nSPC1,1,0,4,5,6\n", {3, 4, 5, 6, 7}), "nyynn");
}

/// What the shells behind one that is defined again have of their own goes with them.
TEST(NastranElementIds, shells_behind_one_that_is_left_out_keep_what_is_theirs) {
  const DeckFolder folder;
  const auto opened = folder.open(
      kFourGrids +
      "CQUAD4,1,1,1,2,3,4\nCQUAD4,1,1,1,2,3,4\nCQUAD4,5,1,1,2,3,4\n,,,2.,2.,2.,2.\nCQUAD4*,6,1,1,2\n*,3,4\nCQUAD8,7,1,1,2,3,4,5\n"
      "CQUAD4,8,1,1,2,3,4\n,,,3.,3.,3.,3.\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  ASSERT_EQ(model.shell_count(), 5u);
  EXPECT_EQ(model.shell_thickness[model.find_shell(5).value], 2.f);
  EXPECT_EQ(model.shell_thickness[model.find_shell(7).value], 0.f);
  EXPECT_EQ(model.shell_thickness[model.find_shell(8).value], 3.f);
  ASSERT_EQ(model.midside->size(), 1u);
  EXPECT_EQ((*model.midside)[0].shell, model.find_shell(7));
  const auto style = [&](std::int64_t id) { return static_cast<nastran::Layout>(opened->deck->run_of(model.find_shell(id)).style); };
  EXPECT_EQ(style(5), nastran::Layout::free_small);
  EXPECT_EQ(style(6), nastran::Layout::free_large);
  EXPECT_EQ(style(7), nastran::Layout::free_small);
}

TEST(NastranWarnings, told_to_stop_the_reader_stops) {
  const DeckFolder folder;
  const auto path = folder.write("deck.bdf", "BEGIN BULK\n" + kFourGrids + "ENDDATA\n");
  int stop = 0;
  for (bool done = false; !done; ++stop) {
    int asked = 0;
    const auto opened = deck::open(path, [&](double) { return asked++ < stop; });
    done = opened.has_value();
    if (done) break;
    EXPECT_EQ(opened.error().message, cancelled().message);
    ASSERT_LT(stop, 100);
  }
  EXPECT_GE(stop, 3);
}

/// Where the nodes of a deck stand, by id.
std::string nodes_by_replication(const DeckFolder& folder, const std::string& text) {
  const auto opened = deck::open(folder.write("deck.bdf", "BEGIN BULK\n" + text + "ENDDATA\n"));
  if (!opened) return opened.error().text();
  std::string out;
  for (std::size_t n = 0; n < opened->model.node_count(); ++n) {
    char line[100];
    const Vec3 at = opened->model.positions[n];
    std::snprintf(line, sizeof line, "%d: %g %g %g\n", static_cast<int>(opened->model.node_ids[n]), at[0], at[1], at[2]);
    out += line;
  }
  for (const Warning& warning : opened->deck->warnings) out += warning.kind + " " + std::to_string(warning.line) + "\n";
  return out;
}

TEST(NastranReplications, make_what_the_manual_says) {
  const std::pair<const char*, const char*> cases[] = {
      // Each copy raises what the one before has; a count needs no parentheses, an increment neither.
      {"GRID,1,,0.,1.,2.\n=,*1,=,*-.5,*(1.),==\n=2\n", "1: 0 1 2\n2: -0.5 2 2\n3: -1 3 2\n4: -1.5 4 2\n"},
      // A field that is neither = nor * is what it says, also where it is blank.
      {"GRID,10,,1.,2.,3.\n=,*10,,5.,=,*(2)\n=(1)\n", "10: 1 2 3\n20: 5 2 5\n30: 5 2 7\n"},
      {"GRID,1,,1.,2.,3.\n=,*1,=,,==\n", "1: 1 2 3\n2: 0 2 3\n"},
      // A whole number may be raised by a part; ids go down as well.
      {"GRID,9,,1,0.,0.\n=,*(-4),=,*.25,==\n", "9: 1 0 0\n5: 1.25 0 0\n"},
      // A second kind of copy goes on from the first, and the count repeats the last.
      {"GRID,1,,0.,0.,0.\n=,*1,=,*1.,==\n=,*2,=,*10.,==\n=(2)\n", "1: 0 0 0\n2: 1 0 0\n4: 11 0 0\n6: 21 0 0\n8: 31 0 0\n"},
      // Each card that is followed by a copy is a template anew.
      {"GRID,1\n=,*1,==\nGRID,7,,3.\n=,*1,==\n", "1: 0 0 0\n2: 0 0 0\n7: 3 0 0\n8: 3 0 0\n"},
      // In columns, and of a large field card.
      {"GRID           1              0.      1.      2.\n=           *(1)       =   *(.5)      ==\n=(1)\n",
       "1: 0 1 2\n2: 0.5 1 2\n3: 1 1 2\n"},
      {"GRID*,1,,0.,1.\n*,2.\n=,*1,=,*.5,==\n", "1: 0 1 2\n2: 0.5 1 2\n"},
      // What isn't understood makes nothing, and what builds on it neither.
      {"GRID,1,,0.,1.,2.\n=,%(2),==\n=(3)\n", "1: 0 1 2\nunread-replication 3\n"},
      {"GRID,1,,0.,1.,2.\n=,=7,==\n", "1: 0 1 2\nunread-replication 3\n"},
      {"GRID,1,,0.,1.,2.\n=,*1,==\n=(0)\n", "1: 0 1 2\n2: 0 1 2\nunread-replication 4\n"},
      {"GRID,1,,0.,1.,2.\n=,*1,==\n=(-1)\n", "1: 0 1 2\n2: 0 1 2\nunread-replication 4\n"},
      {"GRID,1,,0.,1.,2.\n=,*1,==\n=(x)\n", "1: 0 1 2\n2: 0 1 2\nunread-replication 4\n"},
      // A count repeats a copy: of the card alone it makes nothing.
      {"GRID,1,,0.,1.,2.\n=(2)\n", "1: 0 1 2\nunread-replication 3\n"},
  };
  const DeckFolder folder;
  for (const auto& [text, wanted] : cases) EXPECT_EQ(nodes_by_replication(folder, text), wanted) << text;
}

TEST(NastranReplications, have_the_lines_of_the_copy) {
  const DeckFolder folder;
  const std::string grids = "GRID,1,,0.,0.,0.\n=,*1,=,*1.,==\n=(8)\nCHEXA,1,2,1,2,3,4,5,6\n,7,8\n";
  const auto solids = [&](const std::string& copy) {
    const auto opened = folder.open(grids + copy);
    EXPECT_TRUE(opened) << opened.error().text();
    std::string out;
    if (!opened) return out;
    const ElementBlock& block = *opened->model.elements[static_cast<std::size_t>(ElementClass::solid)];
    for (std::size_t e = 0; e < block.size(); ++e) {
      out += std::to_string(block.id[e]) + ":";
      for (std::uint32_t n = block.first_node[e]; n < block.first_node[e + 1]; ++n)
        out += " " + std::to_string(opened->model.node_ids[block.nodes[n].value]);
      out += "\n";
    }
    return out + std::to_string(warning(*opened->deck, "incomplete-element").count);
  };
  EXPECT_EQ(solids("=,*1,=,*1,*1,*1,*1,*1,*1\n,*1,*1\n"), "1: 1 2 3 4 5 6 7 8\n2: 2 3 4 5 6 7 8 9\n0");
  EXPECT_EQ(solids("=,*1,=,*1,==\n,=,10\n"), "1: 1 2 3 4 5 6 7 8\n2: 2 2 3 4 5 6 7 10\n0") << "== means the rest of its line";
  EXPECT_EQ(solids("=,*1,=,*1,==\n,==\n"), "1: 1 2 3 4 5 6 7 8\n2: 2 2 3 4 5 6 7 8\n0");
  EXPECT_EQ(solids("=,*1,==\n"), "1: 1 2 3 4 5 6 7 8\n1") << "without its second line a copy has no seventh node";
}

}  // namespace
}  // namespace prismesh::mesh::deck
