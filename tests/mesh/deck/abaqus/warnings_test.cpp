// What the reader of Abaqus input warns of or refuses: the sentence and the line it names; and where instances and systems put nodes.
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/growing.h"

namespace prismesh::mesh::deck {
namespace {

const std::string kThreeNodes = "*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,1.,1.,0.\n";
const std::string kPart = "*PART,NAME=P\n" + kThreeNodes + "*ELEMENT,TYPE=S3\n1,1,2,3\n*END PART\n*ASSEMBLY,NAME=A\n";

struct AbaqusWarned {
  std::string text;
  const char* kind;
  long line;
  const char* message;
};

TEST(AbaqusWarnings, name_the_line_and_what_is_odd_there) {
  const AbaqusWarned cases[] = {
      {"*PART,NAME=P\n" + kThreeNodes + "*END PART\n*PART,NAME=p\n*END PART\n", "duplicate-part", 7,
       "the part P is defined again; its first definition counts"},
      {kPart + "*INSTANCE,NAME=I,PART=Q\n*END INSTANCE\n", "unread-instance", 10,
       "the instance I is of no part of this deck, so it isn't shown; it is kept as it is"},
      {kPart + "*INSTANCE,NAME=I,PART=P\n1.,x,0.\n*END INSTANCE\n", "unread-instance", 10,
       "where the instance I stands can't be made out; it is shown where its part stands"},
      {kPart + "*INSTANCE,NAME=I,PART=P\n5.,0.,0.\n1.,1.,1.,1.,1.,1.,90.\n*END INSTANCE\n", "unread-instance", 10,
       "where the instance I stands can't be made out; it is shown where its part stands"},
      {kThreeNodes + "*ELEMENT,TYPE=,ELSET=E\n1,1,2,3\n", "unread-elements", 5,
       "*ELEMENT without TYPE=: the elements that follow aren't shown; their text is kept"},
      {"*HEADING\nx\n*SYSTEM\n0.,0.,0.,0.,0.,0.\n" + kThreeNodes, "unread-system", 3,
       "the points of this *SYSTEM span no coordinate system; nodes in it are shown as if it weren't there, and can't be moved"},
      {"*HEADING\nx\n*SYSTEM\n0.,0.,0.,1.,0.,0.\n2.,0.,0.\n" + kThreeNodes, "unread-system", 3,
       "the points of this *SYSTEM span no coordinate system; nodes in it are shown as if it weren't there, and can't be moved"},
      {"*HEADING\nx\n*SYSTEM\n0.,y,0.\n" + kThreeNodes, "unread-system", 3,
       "the points of this *SYSTEM span no coordinate system; nodes in it are shown as if it weren't there, and can't be moved"},
  };
  const DeckFolder folder;
  for (const AbaqusWarned& wanted : cases) {
    SCOPED_TRACE(wanted.text);
    const auto opened = deck::open(folder.write("deck.inp", wanted.text));
    ASSERT_OPENED(opened);
    const Warning found = warning(*opened->deck, wanted.kind);
    EXPECT_EQ(found.count, 1u);
    EXPECT_EQ(found.line, wanted.line);
    EXPECT_EQ(found.message, wanted.message);
    EXPECT_EQ(found.file, (folder / "deck.inp").string());
    // Whatever stands somewhere unknown is shown as it is written.
    if (opened->model.find_node(3).valid()) {
      EXPECT_EQ(position_of(opened->model, 3), Vec3(1, 1, 0));
    }
  }
}

TEST(AbaqusWarnings, nodes_of_a_system_that_spans_none_stay) {
  const DeckFolder folder;
  const auto opened = folder.open("*HEADING\nx\n*SYSTEM\n0.,0.,0.,0.,0.,0.\n*NODE\n1,1.,0.,0.\n*SYSTEM\n*NODE\n2,2.,0.,0.\n");
  ASSERT_OPENED(opened);
  EXPECT_FALSE(save(*opened->deck, opened->model, with_node_at(opened->model, 1, {5, 0, 0}), folder / "out.inp"));
  EXPECT_TRUE(save(*opened->deck, opened->model, with_node_at(opened->model, 2, {5, 0, 0}), folder / "out.inp"));
}

TEST(AbaqusWarnings, cards_with_unknown_parameters_or_no_nodes_are_left_out) {
  const DeckFolder folder;
  const auto opened = folder.open(kThreeNodes + "<n>,5.,5.,5.\n*ELEMENT,TYPE=MASS\n7,0\n8,1\n*ELEMENT,TYPE=S3\n9,1,2,3\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 3u);
  EXPECT_EQ(warning(*opened->deck, "undefined-parameter").count, 1u);
  EXPECT_EQ(warning(*opened->deck, "undefined-parameter").line, 5);
  EXPECT_EQ(warning(*opened->deck, "incomplete-element").count, 1u);
  EXPECT_EQ(warning(*opened->deck, "incomplete-element").line, 7);
  EXPECT_EQ(opened->model.elements[static_cast<std::size_t>(ElementClass::mass)]->id, std::vector<std::int64_t>{8});
}

TEST(AbaqusWarnings, what_cant_be_an_element_is_named) {
  const DeckFolder folder;
  const auto opened = folder.open(kThreeNodes + "*ELEMENT,TYPE=S3\n1,1,2,3\n1.5,1,2,3\n");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().line, 7);
  EXPECT_EQ(opened.error().message, "expected an element number but found \"1.5\"");
}

TEST(AbaqusWarnings, instances_need_room_for_their_numbers) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*PART,NAME=P\n*NODE\n899999999999999999,0.,0.,0.\n*END PART\n*ASSEMBLY,NAME=A\n*INSTANCE,NAME=I,PART=P\n*END INSTANCE\n"
      "*INSTANCE,NAME=J,PART=P\n1.,0.,0.\n*END INSTANCE\n*END ASSEMBLY\n");
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().file, (folder / "deck.k").string());
  EXPECT_EQ(opened.error().message, "has instances whose numbers are too large to be told apart");
}

/// 64 files may stand in each other below the main one.
TEST(AbaqusWarnings, includes_nest_only_so_deep) {
  const DeckFolder folder;
  const auto name = [](int depth) { return "f" + std::to_string(depth) + ".inp"; };
  for (int depth = 1; depth <= 65; ++depth)
    folder.write(name(depth), "*NODE\n" + std::to_string(depth) + ",0.,0.,0.\n*INCLUDE,INPUT=" + name(depth + 1) + "\n");
  folder.write(name(66), "*NODE\n66,0.,0.,0.\n");
  const auto opened = folder.open("*HEADING\nx\n*INCLUDE,INPUT=f1.inp\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 64u);
  const Warning deep = warning(*opened->deck, "deep-include");
  EXPECT_EQ(deep.count, 1u);
  EXPECT_EQ(deep.line, 3);
  EXPECT_EQ(deep.file, (folder / "f64.inp").string());
  EXPECT_EQ(deep.message, "the include file f65.inp is nested more than 64 deep; it isn't read");
}

TEST(AbaqusWarnings, told_to_stop_the_reader_stops) {
  const DeckFolder folder;
  const auto path = folder.write("deck.inp", kThreeNodes);
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

/// The three nodes of the part as an instance with these data lines shows them.
std::vector<Vec3> as_instance(const DeckFolder& folder, const std::string& lines) {
  const auto opened = folder.open(kPart + "*INSTANCE,NAME=I,PART=P\n" + lines + "*END INSTANCE\n*END ASSEMBLY\n");
  EXPECT_TRUE(opened) << opened.error().text();
  if (!opened) return {};
  EXPECT_EQ(warning(*opened->deck, "unread-instance").count, 0u);
  return {position_of(opened->model, 1), position_of(opened->model, 2), position_of(opened->model, 3)};
}

void expect_places(const std::vector<Vec3>& found, const std::vector<Vec3>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_LT((found[i] - wanted[i]).norm(), 1e-12) << i << ": " << found[i].transpose();
}

TEST(AbaqusInstances, are_moved_and_then_turned) {
  const DeckFolder folder;
  expect_places(as_instance(folder, ""), {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  expect_places(as_instance(folder, "10.,20.,30.\n"), {{10, 20, 30}, {11, 20, 30}, {11, 21, 30}});
  expect_places(as_instance(folder, "10.\n"), {{10, 0, 0}, {11, 0, 0}, {11, 1, 0}});
  // A quarter of a turn about the line through (10, 5, 0) along y, a point further on, whichever.
  expect_places(as_instance(folder, "10.,0.,0.\n10.,5.,0., 10.,7.,0., 90.\n"), {{10, 0, 0}, {10, 0, -1}, {10, 1, -1}});
  expect_places(as_instance(folder, "10.,0.,0.\n10.,5.,0., 10.,3.,0., 90.\n"), {{10, 0, 0}, {10, 0, 1}, {10, 1, 1}});
  // A third of a turn about the diagonal takes x to y, y to z and z to x.
  expect_places(as_instance(folder, "0.,0.,4.\n0.,0.,0., 2.,2.,2., 120.\n"), {{4, 0, 0}, {4, 1, 0}, {4, 1, 1}});
  // No turn needs no axis.
  expect_places(as_instance(folder, "1.,0.,0.\n2.,2.,2., 2.,2.,2., 0.\n"), {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}});
}

TEST(AbaqusInstances, a_moved_node_is_written_as_its_part_has_it) {
  const DeckFolder folder;
  const std::string text =
      "*PART,NAME=P\n*SYSTEM\n0.,0.,7.\n*NODE,SYSTEM=C\n1,2.,90.,1.\n*SYSTEM\n*NODE\n2,1.,2.,3.\n*END PART\n"
      "*ASSEMBLY,NAME=A\n*INSTANCE,NAME=I,PART=P\n0.,0.,4.\n0.,0.,0., 2.,2.,2., 120.\n*END INSTANCE\n*END ASSEMBLY\n";
  const auto opened = folder.open(text);
  ASSERT_OPENED(opened);
  // (0, 2, 8) and (1, 2, 3), four up, then x becomes y, y becomes z, z becomes x.
  expect_places({position_of(opened->model, 1), position_of(opened->model, 2)}, {{12, 0, 2}, {7, 1, 2}});
  Model model = with_node_at(opened->model, 1, {12, 0, 2.5});
  model = with_node_at(model, 2, {7.5, 1, 2});
  const auto saved = save(*opened->deck, opened->model, model, folder / "out.inp");
  ASSERT_TRUE(saved) << saved.error().text();
  const LineDifference lines = line_difference(text, content(folder / "out.inp"));
  ASSERT_EQ(lines.come.size(), 2u);
  EXPECT_NEAR(std::stod(lines.come[0].substr(2)), 2.5, 1e-12) << "the way there and back costs the last digits";
  EXPECT_EQ(lines.come[0].substr(lines.come[0].find(',', 2)), ",90.,1.");
  EXPECT_EQ(lines.come[1], "2,1.,2.,3.5");
  EXPECT_EQ(lines.gone.size(), 2u);
}

TEST(AbaqusSystems, stand_until_the_next_or_the_end_of_the_part) {
  const DeckFolder folder;
  // x along y, so that y points along -x; without a third point about the global z axis.
  const auto opened = folder.open(
      "*SYSTEM\n10.,0.,0.\n*NODE\n1,1.,2.,3.\n*SYSTEM\n10.,0.,0.,10.,5.,0.\n*NODE\n2,1.,2.,3.\n*NODE,SYSTEM=R\n3,1.,2.,3.\n"
      "*SYSTEM\n0.,0.,0.,0.,0.,5.\n1.,0.,0.\n*NODE\n4,1.,2.,3.\n*PART,NAME=P\n*NODE\n5,1.,2.,3.\n*SYSTEM\n1.,1.,1.\n*NODE\n6,1.,2.,3.\n"
      "*END PART\n*NODE\n7,1.,2.,3.\n");
  ASSERT_OPENED(opened);
  std::vector<Vec3> places;
  for (int id = 1; id <= 7; ++id) places.push_back(position_of(opened->model, id));
  expect_places(places, {{11, 2, 3}, {8, 1, 3}, {8, 1, 3}, {2, 3, 1}, {1, 2, 3}, {2, 3, 4}, {1, 2, 3}});
}

TEST(AbaqusSets, ranges_and_names_give_parts_their_shells) {
  const DeckFolder folder;
  std::string text = kThreeNodes + "*ELEMENT,TYPE=S3\n";
  for (int id = 1; id <= 9; ++id) text += std::to_string(id) + ",1,2,3\n";
  const auto opened = folder.open(text +
                                  "*ELSET,ELSET=odd,GENERATE\n1,5,2\n*ELSET,ELSET=odd,GENERATE\n9,9\n*ELSET,ELSET=even,GENERATE\n2,8,2\n"
                                  "*SHELL SECTION,ELSET=odd\n1.,\n*SHELL SECTION,ELSET=even\n2.,\n");
  ASSERT_OPENED(opened);
  std::string parts;
  for (int id = 1; id <= 9; ++id)
    parts += (*opened->model.parts)[opened->model.shell_parts[opened->model.find_shell(id).value].value].name + " ";
  EXPECT_EQ(parts, "odd even odd even odd even  even odd ");
}

}  // namespace
}  // namespace prismesh::mesh::deck
