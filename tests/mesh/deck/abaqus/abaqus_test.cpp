// Abaqus input: what is read, from decks of our own.
#include "mesh/deck/abaqus/element_type.h"
#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

const Part* part_of(const Model& model, std::int64_t shell) {
  const ShellIndex index = model.find_shell(shell);
  if (!index.valid() || !model.shell_parts[index.value].valid()) return nullptr;
  return &(*model.parts)[model.shell_parts[index.value].value];
}

const ElementBlock& block(const Model& model, ElementClass of) { return *model.elements[static_cast<std::size_t>(of)]; }

const char kFlat[] =
    "*HEADING\nA plate\n** comment\n*Node, NSet=all\n1, 0., 0., 0.\n  2, 1.0,0 ,\n3,1,1,0.0, 0., 0., 1.\n** between\n4,0,1\n5, 2.,0.\n"
    "* element ,\n** and here\n TYPE = s4r ,elset=\"Left\"\n 10, 1, 2,\n 3, 4\n*ELEMENT,TYPE=S3,ELSET=right\n11, 2, 5, 3,\n"
    "*SHELL SECTION, ELSET=LEFT, MATERIAL=steel\n 1.5, 5\n*SHELL SECTION, ELSET=right, COMPOSITE\n 0.5,3,foam\n0.25,3,steel\n"
    "*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*DENSITY\n7.85E-9,\n*MATERIAL, "
    "NAME=Foam\n*ELASTIC,TYPE=LAMINA\n100.,200.,.25,1.,1.,1.\n*STEP\n*STATIC\n*END STEP\n";

TEST(Abaqus, reads_a_flat_deck) {
  const DeckFolder folder;
  const auto opened = folder.open(kFlat);
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  EXPECT_EQ(model.node_count(), 5u);
  EXPECT_EQ(position_of(model, 2), Vec3(1, 0, 0));
  EXPECT_EQ(position_of(model, 4), Vec3(0, 1, 0));
  EXPECT_EQ(corners_of(model, 10), (std::array<std::int64_t, 4>{1, 2, 3, 4}));
  EXPECT_EQ(corners_of(model, 11), (std::array<std::int64_t, 4>{2, 5, 3, 3}));
  EXPECT_EQ(opened->deck->element_kinds, (std::map<std::string, std::size_t, std::less<>>{{"S3", 1}, {"S4R", 1}}));
  EXPECT_EQ(opened->deck->element_cards.quad, 1u);
  EXPECT_EQ(opened->deck->element_cards.tri, 1u);
  const Part* left = part_of(model, 10);
  ASSERT_TRUE(left);
  EXPECT_EQ(left->name, "LEFT");
  EXPECT_TRUE(left->defined);
  EXPECT_EQ(left->thickness, 1.5);
  EXPECT_EQ(left->density, 7.85e-9);
  EXPECT_EQ(left->youngs_modulus, 210000);
  EXPECT_EQ(left->poissons_ratio, 0.3);
  const Part* right = part_of(model, 11);
  ASSERT_TRUE(right);
  EXPECT_EQ(right->thickness, 0.75);
  EXPECT_EQ(right->youngs_modulus, 200);
  EXPECT_TRUE(opened->deck->warnings.empty());
}

TEST(Abaqus, knows_no_thickness_where_a_section_gives_something_else) {
  const DeckFolder folder;
  const auto part = [&](const std::string& section) {
    const auto opened =
        folder.open("*NODE\n1,0.,0.\n2,1.,0.\n3,1.,1.\n*ELEMENT,TYPE=S3,ELSET=e\n1,1,2,3\n*MATERIAL,NAME=m\n*ELASTIC\n1.,.3\n" + section);
    EXPECT_TRUE(opened) << opened.error().text();
    const Part* found = opened ? part_of(opened->model, 1) : nullptr;
    return found ? *found : Part();
  };
  EXPECT_EQ(part("*SHELL SECTION,ELSET=e,MATERIAL=m\n1.5,5\n").thickness, 1.5);
  EXPECT_FALSE(part("*SHELL SECTION,ELSET=e,MATERIAL=m,NODAL THICKNESS\n1.5,5\n").thickness);
  EXPECT_FALSE(part("*SHELL SECTION,ELSET=e,MATERIAL=m,SHELL THICKNESS=d\n1.5,5\n").thickness);
  EXPECT_EQ(part("*SHELL GENERAL SECTION,ELSET=e,MATERIAL=m\n2.5\n").thickness, 2.5);
  EXPECT_FALSE(part("*SHELL GENERAL SECTION,ELSET=e\n11.,12.,13.\n").thickness) << "a stiffness";
  EXPECT_TRUE(part("*SHELL SECTION,ELSET=e,MATERIAL=m\n1.5,5\n").limits_time_step);
  EXPECT_FALSE(part("*SHELL SECTION,ELSET=e,MATERIAL=m\n1.5,5\n*RIGID BODY,REF NODE=1,ELSET=E\n").limits_time_step);
}

TEST(Abaqus, takes_for_a_keyword_what_begins_a_line_with_a_star) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*HEADING\nloads of 3 *node and * element\n*NODE, NSET=all,\n  *NODE\n1,0.,0.\n2,1.,0.\n3,1.,1.\n"
      "*ELEMENT,TYPE=S3,ELSET=e\n1,1,2,3\n2,1,2,\n*SHELL SECTION,ELSET=e,MATERIAL=m\n1.\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 3u);
  EXPECT_EQ(opened->model.shell_count(), 1u);
  EXPECT_EQ(warning(*opened->deck, "incomplete-element").count, 1u) << "one shell has a corner too few";
}

TEST(Abaqus, knows_its_element_types) {
  using abaqus::element_type;
  const auto is = [](std::string_view type, ElementClass element_class, int nodes, int corners = 0) {
    const abaqus::ElementType known = element_type(type);
    EXPECT_EQ(known.element_class, element_class) << type;
    EXPECT_EQ(known.nodes, nodes) << type;
    EXPECT_EQ(known.corners, corners) << type;
  };
  for (const char* type : {"S3", "S3R", "S3RS", "STRI3", "M3D3", "R3D3", "SFM3D3"}) is(type, ElementClass::shell, 3, 3);
  for (const char* type : {"S6", "STRI65", "M3D6"}) is(type, ElementClass::shell, 6, 3);
  for (const char* type : {"S4", "S4R", "S4RS", "S4R5", "S4RSW", "M3D4R", "R3D4", "SFM3D4R"}) is(type, ElementClass::shell, 4, 4);
  for (const char* type : {"S8R", "S8R5", "S8", "M3D8"}) is(type, ElementClass::shell, 8, 4);
  is("S9R5", ElementClass::shell, 9, 4);
  is("C3D8R", ElementClass::solid, 8);
  is("C3D20R", ElementClass::solid, 20);
  is("C3D10M", ElementClass::solid, 10);
  is("COH3D6", ElementClass::solid, 6);
  is("SC8R", ElementClass::tshell, 8);
  is("SC6R", ElementClass::tshell, 6);
  is("B31", ElementClass::beam, 2);
  is("B32R", ElementClass::beam, 3);
  is("B33", ElementClass::beam, 2);
  is("PIPE31", ElementClass::beam, 2);
  is("T3D2", ElementClass::beam, 2);
  is("T3D3", ElementClass::beam, 3);
  is("CONN3D2", ElementClass::discrete, 2);
  is("SPRING1", ElementClass::discrete, 1);
  is("SPRINGA", ElementClass::discrete, 2);
  is("DASHPOTA", ElementClass::discrete, 2);
  is("MASS", ElementClass::mass, 1);
  is("ROTARYI", ElementClass::mass, 1);
  is("PC3D", ElementClass::sph, 1);
  is("SAX1", ElementClass::other, 2);
  is("D", ElementClass::other, 3);
  is("CPS4", ElementClass::other, 4);
  is("U1", ElementClass::other, 0);
}

TEST(Abaqus, shows_other_elements_as_what_they_are) {
  const DeckFolder folder;
  std::string nodes = "*NODE\n";
  for (int n = 1; n <= 20; ++n) nodes += std::to_string(n) + "," + std::to_string(n) + ".,0.,0.\n";
  const auto opened =
      folder.open(nodes +
                  "*ELEMENT,TYPE=C3D20\n1,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15\n16,17,18,19,20\n*ELEMENT,TYPE=C3D8\n2,1,2,3,4,5,6,7,8,\n3,1,"
                  "2,3,4,5,6,7,8\n"
                  "*ELEMENT,TYPE=B31\n4,1,2\n*ELEMENT,TYPE=MASS\n5,7\n*ELEMENT,TYPE=SPRINGA\n6,7,8\n*ELEMENT,TYPE=SC8R\n7,1,2,3,4,5,6,7,8\n"
                  "*ELEMENT,TYPE=D\n8,0,1,2\n9,3,4,5\n*ELEMENT,TYPE=S8R\n10,1,2,3,4,5,6,7,8\n*ELEMENT,TYPE=U3,ELSET=x\n11,1,2,\n3,4\n*"
                  "ELEMENT,TYPE=B32\n12,1,2\n");
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  EXPECT_EQ(block(model, ElementClass::solid).size(), 3u);
  EXPECT_EQ(block(model, ElementClass::solid).first_node, (std::vector<std::uint32_t>{0, 20, 28, 36}));
  EXPECT_EQ(block(model, ElementClass::beam).size(), 1u);
  EXPECT_EQ(block(model, ElementClass::mass).size(), 1u);
  EXPECT_EQ(block(model, ElementClass::discrete).size(), 1u);
  EXPECT_EQ(block(model, ElementClass::tshell).size(), 1u);
  EXPECT_EQ(block(model, ElementClass::other).size(), 3u);
  EXPECT_EQ(block(model, ElementClass::other).nodes.size(), 2u + 3u + 4u);
  ASSERT_EQ(model.midside->size(), 1u);
  EXPECT_EQ(model.node_ids[(*model.midside)[0].node[3].value], 8);
  EXPECT_EQ(warning(*opened->deck, "incomplete-element").count, 1u);
  EXPECT_EQ(opened->deck->element_cards.beam, 2u);
  EXPECT_EQ(opened->deck->element_cards.quad8, 1u);
}

TEST(Abaqus, finds_parts_through_sets_of_sets) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*NODE\n1,0,0\n2,1,0\n3,1,1\n*ELEMENT,TYPE=S3,ELSET=a\n1,1,2,3\n2,1,2,3\n*ELEMENT,TYPE=S3\n3,1,2,3\n4,1,2,3\n5,1,2,3\n6,1,2,3\n7,1,2,"
      "3\n8,1,2,3\n"
      "*ELSET,ELSET=odd,GENERATE\n3,7,2\n*ELSET,ELSET=both\na, 4\n*ELSET,ELSET=loop\nloop,both\n"
      "*SHELL SECTION,ELSET=loop\n1.\n*SHELL SECTION,ELSET=odd\n2.\n*SHELL SECTION,ELSET=a\n3.\n");
  ASSERT_OPENED(opened);
  const std::map<int, const char*> wanted = {{1, "loop"}, {2, "loop"}, {3, "odd"}, {4, "loop"}, {5, "odd"}, {6, ""}, {7, "odd"}, {8, ""}};
  for (const auto& [shell, name] : wanted) {
    const Part* part = part_of(opened->model, shell);
    ASSERT_TRUE(part) << shell;
    EXPECT_EQ(part->name, name) << shell;
    EXPECT_EQ(part->defined, *name != '\0');
  }
}

TEST(Abaqus, reads_includes_among_data_lines) {
  const DeckFolder folder;
  folder.write("more/nodes.inp", "2,1.,0.,0.\r\n3,1.,1.,0.\r\n*INCLUDE, INPUT=last.inp\r\n");
  folder.write("more/last.inp", "4,0,1.,0.");
  folder.write("elements.inp", "1,1,2,3,4\n");
  const auto opened = folder.open(
      "*HEADING\nx\n*NODE\n1,0,0,0\n*INCLUDE, INPUT=more\\nodes.inp\n5,9.,9.,9.\n*ELEMENT,TYPE=S4,INPUT=elements.inp\n2,1,2,3,5\n"
      "*INCLUDE,INPUT=absent.inp\n*NSET,NSET=n\n1,2\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 5u);
  EXPECT_EQ(opened->model.shell_count(), 2u);
  EXPECT_EQ(position_of(opened->model, 4), Vec3(0, 1, 0));
  EXPECT_EQ(opened->deck->files.size(), 4u);
  EXPECT_EQ(opened->deck->missing_files, std::vector<std::string>{"absent.inp"});
  EXPECT_EQ(warning(*opened->deck, "missing-include").line, 9);
  Model model = with_node_at(opened->model, 3, {2, 1, 0});
  model = with_node_at(model, 4, {0, 1, 0.5});
  const auto saved = save(*opened->deck, opened->model, model, folder / "out/deck.inp");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(content(folder / "out/more/nodes.inp"), "2,1.,0.,0.\r\n3,2.0,1.,0.\r\n*INCLUDE, INPUT=last.inp\r\n");
  EXPECT_EQ(content(folder / "out/more/last.inp"), "4,0,1.,0.5");
}

TEST(Abaqus, survives_includes_that_go_in_circles) {
  const DeckFolder folder;
  folder.write("a.inp", "*INCLUDE,INPUT=b.inp\n2,1.,0.,0.\n");
  folder.write("b.inp", "*INCLUDE,INPUT=a.inp\n");
  const auto opened = folder.open("*HEADING\nx\n*NODE\n*INCLUDE,INPUT=a.inp\n*INCLUDE,INPUT=a.inp\n*INCLUDE\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 1u);
  EXPECT_EQ(warning(*opened->deck, "circular-include").count, 1u);
  EXPECT_EQ(warning(*opened->deck, "repeated-include").count, 1u);
}

TEST(Abaqus, places_nodes_by_their_systems_and_moves_them_there) {
  const DeckFolder folder;
  const std::string text =
      "*HEADING\nx\n*SYSTEM\n10.,0.,0., 10.,1.,0.\n9.,0.,0.\n*NODE\n1, 1.,2.,3.\n*NODE,SYSTEM=C\n2, 2., 90., 5.\n*SYSTEM\n*NODE,SYSTEM=S\n"
      "3, 2., 90., 90.\n*NODE\n4,1.,1.,1.\n";
  const auto opened = folder.open(text);
  ASSERT_OPENED(opened);
  const auto near = [&](const Model& model, std::int64_t id, const Vec3& wanted) {
    EXPECT_LT((position_of(model, id) - wanted).norm(), 1e-12) << id << ": " << position_of(model, id).transpose();
  };
  near(opened->model, 1, {8, 1, 3});
  near(opened->model, 2, {8, 0, 5});
  near(opened->model, 3, {0, 2, 0});
  near(opened->model, 4, {1, 1, 1});
  Model model = with_node_at(opened->model, 1, {8, 1.5, 3});
  model = with_node_at(model, 2, {7, 0, 5});
  const auto saved = save(*opened->deck, opened->model, model, folder / "out.inp");
  ASSERT_TRUE(saved) << saved.error().text();
  std::string wanted = text;
  wanted.replace(wanted.find("1, 1.,2.,3."), 11, "1, 1.5,2.,3.");
  wanted.replace(wanted.find("2, 2., 90., 5."), 14, "2, 3.0, 90., 5.");
  EXPECT_EQ(content(folder / "out.inp"), wanted);
}

const char kAssembly[] =
    "*Heading\nx\n*Part, name=Plate\n*Node\n1,0.,0.,0.\n2,1.,0.,0.\n3,1.,1.,0.\n4,0.,1.,0.\n*Element, type=S4R\n1,1,2,3,4\n"
    "*Elset, elset=all, generate\n1,1,1\n*Nset, nset=rim\n 1, 2\n*Shell Section, elset=all, material=m\n2.,\n*End Part\n"
    "*Part, name=Unused\n*Node\n1,5.,5.,5.\n*End Part\n"
    "*Part, name=Bar\n*Node\n1,0.,0.,0.\n2,0.,0.,1.\n*Element,type=B31\n1,1,2\n*End Part\n"
    "*Assembly, name=A\n*Instance, name=P-1, part=Plate\n10.,0.,0.\n10.,0.,0., 10.,0.,1., 90.\n*End Instance\n"
    "*Instance, name=B-1, part=Bar\n*End Instance\n*Instance, name=B-2, part=Bar\n0.,0.,7.\n*End Instance\n"
    "*Node\n1, 3.,3.,3.\n*Nset, nset=held, instance=P-1\n1,4\n*Element,type=CONN3D2\n1, P-1.1, B-1.2\n*End "
    "Assembly\n*Boundary\nP-1.2,1,3\n";

TEST(Abaqus, places_instances) {
  const DeckFolder folder;
  const auto opened = folder.open(kAssembly);
  ASSERT_OPENED(opened);
  const Model& model = opened->model;
  // The assembly's own node 1 keeps its number; the plate's, as those of both bars, are shown with something added.
  EXPECT_EQ(model.node_count(), 1u + 4u + 2u + 2u);
  EXPECT_EQ(position_of(model, 1), Vec3(3, 3, 3));
  EXPECT_LT((position_of(model, 1002) - Vec3(10, 1, 0)).norm(), 1e-12);
  EXPECT_LT((position_of(model, 3002) - Vec3(0, 0, 8)).norm(), 1e-12);
  EXPECT_EQ(warning(*opened->deck, "renumbered-instance").count, 3u);
  EXPECT_EQ(warning(*opened->deck, "repeated-part").count, 1u);
  EXPECT_EQ(warning(*opened->deck, "unused-part").count, 1u);
  EXPECT_EQ(warning(*opened->deck, "element-between-instances").count, 1u);
  EXPECT_EQ(part_of(model, 1001)->name, "all");
  EXPECT_NE(model.node_holds[model.find_node(2001).value], 0);
  EXPECT_EQ(model.node_holds[model.find_node(1001).value], 0);
  const References& references = *opened->deck->references;
  EXPECT_EQ(references.naming(Referred::node, 1002).size(), 2u);  // rim, and the boundary
  EXPECT_EQ(references.naming(Referred::node, 1004).size(), 1u);
  EXPECT_TRUE(references.naming(Referred::node, 1).empty());
  // A moved node of a turned instance is written in its part's own system.
  const auto saved = save(*opened->deck, model, with_node_at(model, 1002, {10, 1.5, 0}), folder / "out.inp");
  ASSERT_TRUE(saved) << saved.error().text();
  EXPECT_EQ(saved->lines_changed, 1u);
  const auto again = deck::open(folder / "out.inp");
  ASSERT_OPENED(again);
  EXPECT_LT((position_of(again->model, 1002) - Vec3(10, 1.5, 0)).norm(), 1e-12);
  EXPECT_FALSE(save(*opened->deck, model, with_node_at(model, 2001, {1, 1, 1}), folder / "out2.inp"));
}

TEST(Abaqus, shows_parts_without_an_assembly) {
  const DeckFolder folder;
  const auto opened = folder.open("*Part, name=P\n*Node\n1,0.,0.,0.\n2,1.,0.,0.\n3,1.,1.,0.\n*Element, type=S3\n1,1,2,3\n*End Part\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.shell_count(), 1u);
}

TEST(Abaqus, refuses_instances_beyond_all_measure) {
  const DeckFolder folder;
  std::string text = "*Heading\nx\n*Part, name=P\n*Node\n";
  for (int n = 1; n <= 30000; ++n) text += std::to_string(n) + ",0.,0.,0.\n";
  text += "*End Part\n*Assembly\n";
  for (int i = 0; i < 2000; ++i) text += "*Instance,name=I" + std::to_string(i) + ",part=P\n";
  const auto opened = folder.open(text);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("the part P has 2000 instances"), std::string::npos) << opened.error().message;
  EXPECT_EQ(opened.error().line, 3);
}

TEST(Abaqus, holds_what_parameters_give) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*PARAMETER\nwidth = 2.5\nhalf = "
      "width/2\n*NODE\n1,<width>,0.,0.\n2,<half>,0.,0.\n3,0.,0.,0.\n*ELEMENT,TYPE=S3\n1,1,3,3\n2,<n>,1,2\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(position_of(opened->model, 1), Vec3(2.5, 0, 0));
  EXPECT_EQ(opened->model.node_holds[opened->model.find_node(1).value], kHeldByParameter);
  EXPECT_FALSE(opened->model.find_node(2).valid());
  EXPECT_EQ(warning(*opened->deck, "undefined-parameter").count, 2u);
}

TEST(Abaqus, tells_of_what_it_doesnt_read) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*HEADING\nx\n*NODE\n1,0,0,0\n11,10,0,0\n*NGEN,NSET=a\n1,11\n*NGEN\n1,11\n*ELEMENT,TYPE=R3D4\n*ELEMENT\n1,2,3\n*STRANGE WORD\n1,2\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "unread-generation").count, 2u);
  EXPECT_EQ(warning(*opened->deck, "unread-generation").line, 6);
  EXPECT_EQ(warning(*opened->deck, "unread-elements").count, 1u);
  EXPECT_EQ(warning(*opened->deck, "shown-as-shells").count, 1u);
  bool strange = false;
  for (const UnreadText& unread : opened->deck->references->unread()) strange |= unread.keyword == "STRANGE WORD";
  EXPECT_TRUE(strange);
}

TEST(Abaqus, says_where_a_line_is_no_card) {
  const DeckFolder folder;
  const auto fails = [&](const std::string& text, long line, const char* says) {
    const auto opened = folder.open("*HEADING\nx\n" + text);
    ASSERT_FALSE(opened) << text;
    EXPECT_EQ(opened.error().line, line) << text;
    EXPECT_NE(opened.error().message.find(says), std::string::npos) << opened.error().message;
  };
  fails("*NODE\n1,0.,0.\nx,0.,0.\n", 5, "expected a node number but found \"x\"");
  fails("*NODE\n1,0.,abc\n", 4, "the y coordinate of node 1");
  fails("*NODE\n-1,0.,0.\n", 4, "above 0");
  fails("*NODE\n1234567890123456789,0.,0.\n", 4, "expected a node number");
  fails("*ELEMENT,TYPE=S3\n1,a,2,3\n", 4, "expected a node number but found \"a\"");
  fails("*ELEMENT,TYPE=S3\n0,1,2,3\n", 4, "above 0");
}

/// The keywords that name an entity, each with a blank behind it.
std::string words_that_name(const References& references, Referred referred, std::int64_t id) {
  std::string out;
  for (const Reference& r : references.naming(referred, id)) out += references.referrers()[r.referrer].keyword + " ";
  return out;
}

TEST(Abaqus, lists_who_names_what) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*HEADING\nx\n*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n9,5,5,5\n*ELEMENT,TYPE=S4\n1,1,2,3,4\n*NSET,NSET=set\n1,2,other\n "
      "3\n*NSET,NSET=gen,GENERATE\n2,10,2\n"
      "*ELSET,ELSET=e\n1\n*BOUNDARY\nset,1\n4,1,3\n*CLOAD\n2,1,5.\n*DLOAD\n1,P,3.\n*EQUATION\n2\n1,1,1.,2,1,-1.\n*MPC\nBEAM,3,4\n"
      "*RIGID BODY,NSET=set,REF NODE=9\n*SURFACE,NAME=s,TYPE=NODE\n1\n*SURFACE,NAME=t\n1,SPOS\n*NODE PRINT,NSET=set\nU\n*INITIAL "
      "CONDITIONS,TYPE=TEMPERATURE\n2,20.\n");
  ASSERT_OPENED(opened);
  const References& references = *opened->deck->references;
  const auto words = [&](Referred referred, std::int64_t id) { return words_that_name(references, referred, id); };
  EXPECT_EQ(words(Referred::node, 1), "NSET EQUATION SURFACE ");
  EXPECT_EQ(words(Referred::node, 2), "NSET NSET CLOAD EQUATION INITIAL CONDITIONS ");
  EXPECT_EQ(words(Referred::node, 3), "NSET MPC ");
  EXPECT_EQ(words(Referred::node, 4), "NSET BOUNDARY MPC ");
  EXPECT_EQ(words(Referred::node, 9), "RIGID BODY ");
  EXPECT_EQ(words(Referred::shell, 1), "ELSET DLOAD SURFACE ");
  EXPECT_TRUE(references.unread().empty());
  for (const Reference& r : references.naming(Referred::node, 4))
    if (references.referrers()[r.referrer].keyword == "NSET") {
      EXPECT_EQ(r.role, ReferenceRole::range);
    }
}

const char kThreeShells[] = "*HEADING\nx\n*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n*ELEMENT,TYPE=S3\n1,1,2,3\n2,1,2,3\n3,1,2,3\n";

TEST(Abaqus, sets_have_members_in_files_of_their_own) {
  const DeckFolder folder;
  folder.write("nodes.inp", "1,\n3,\n");
  folder.write("range.inp", "2,4,2\n");
  folder.write("shells.inp", "2,3\n");
  const auto opened =
      folder.open(std::string(kThreeShells) +
                  "*NSET,NSET=n,INPUT=nodes.inp\n2\n*NSET,NSET=r,GENERATE,INPUT=range.inp\n*ELSET,ELSET=e,INPUT=shells.inp\n"
                  "*SHELL SECTION,ELSET=e\n1.,\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->deck->files.size(), 4u);
  EXPECT_TRUE(opened->deck->missing_files.empty());
  const References& references = *opened->deck->references;
  EXPECT_EQ(words_that_name(references, Referred::node, 1), "NSET ");
  EXPECT_EQ(words_that_name(references, Referred::node, 2), "NSET NSET ");
  EXPECT_EQ(words_that_name(references, Referred::node, 3), "NSET ");
  EXPECT_EQ(words_that_name(references, Referred::node, 4), "NSET ");
  EXPECT_EQ(words_that_name(references, Referred::shell, 1), "");
  EXPECT_EQ(words_that_name(references, Referred::shell, 3), "ELSET ");
  EXPECT_EQ(part_of(opened->model, 1)->name, "");
  EXPECT_EQ(part_of(opened->model, 2)->name, "e");
  EXPECT_EQ(part_of(opened->model, 3)->name, "e");
}

TEST(Abaqus, a_range_without_an_end_is_one_number) {
  const DeckFolder folder;
  const auto opened = folder.open(std::string(kThreeShells) +
                                  "*NSET,NSET=n,GENERATE\n1\n*NSET,NSET=n,GENERATE\n3,,\n*ELSET,ELSET=e,GENERATE\n2\n"
                                  "*SHELL SECTION,ELSET=e\n1.,\n");
  ASSERT_OPENED(opened);
  const References& references = *opened->deck->references;
  for (const int id : {1, 2, 3, 4})
    EXPECT_EQ(words_that_name(references, Referred::node, id), id == 1 || id == 3 ? "NSET " : "") << "node " << id;
  for (const int id : {1, 2, 3}) {
    EXPECT_EQ(words_that_name(references, Referred::shell, id), id == 2 ? "ELSET " : "") << "shell " << id;
    EXPECT_EQ(part_of(opened->model, id)->name, id == 2 ? "e" : "") << "shell " << id;
  }
}

}  // namespace
}  // namespace prismesh::mesh::deck
