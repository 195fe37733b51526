// Which cards of a keyword deck name what: the tables, keyword by keyword, and truths counted by hand in real decks.
#include "mesh/model/references.h"
#include "mesh/deck/open.h"

#include <cstdlib>
#include <iostream>
#include <set>

#include "mesh/deck/editing/edit_checks.h"
#include "mesh/deck/editing/names.h"
#include "mesh/deck/lsdyna/reference_tables.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

/// Eight nodes, two shells of part 1.
constexpr const char* kTwoShellMesh =
    "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,2,0,0\n6,2,1,0\n7,3,0,0\n8,3,1,0\n"
    "*PART\nsheet\n1,1,1\n*ELEMENT_SHELL\n1,1,1,2,3,4\n2,1,2,5,6,3\n";

/// "node 1-3 list SET_NODE_LIST 7", one line for each reference, without those to what the parts' cards define.
std::string references_of(const Deck& deck) {
  std::string out;
  for (const Reference& r : deck.references->all()) {
    const Referrer& card = deck.references->referrers()[r.referrer];
    out += std::string(name(r.referred)) + " " + std::to_string(r.first);
    if (r.last != r.first) out += "-" + std::to_string(r.last);
    if (r.step != 1) out += "/" + std::to_string(r.step);
    constexpr const char* kRoles[] = {"list", "range", "segment", "single"};
    out += std::string(" ") + kRoles[static_cast<int>(r.role)];
    if (card.id > 0) out += " of " + std::to_string(card.id);
    out += "\n";
  }
  return out;
}

struct Said {
  std::string references;
  std::size_t unread = 0;
};

Said read(const std::string& cards) {
  const DeckFolder folder;
  const auto opened = folder.open("*KEYWORD\n" + cards + "*END\n");
  if (!opened) return {opened.error().text(), 0};
  return {references_of(*opened->deck), opened->deck->references->unread().size()};
}

struct Example {
  const char* cards;
  const char* references;
};

class Cards : public ::testing::TestWithParam<Example> {};

TEST_P(Cards, name_what_the_manual_says) {
  const Said said = read(GetParam().cards);
  EXPECT_EQ(said.references, GetParam().references) << GetParam().cards;
  EXPECT_EQ(said.unread, 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Sets, Cards,
    ::testing::Values(Example{"*SET_NODE_LIST_TITLE\nrim\n7\n1,2,3,9\n", "node 1-3 list of 7\nnode 9 list of 7\n"},
                      Example{"*SET_NODE\n         7       0.0       0.0\n         1        12\n", "node 1 list of 7\nnode 12 list of 7\n"},
                      Example{"*SET_NODE_LIST +\n                   7\n                   1                  12\n",
                              "node 1 list of 7\nnode 12 list of 7\n"},
                      Example{"*SET_NODE_COLUMN\n7\n4,0.5\n6,0.5\n", "node 4 list of 7\nnode 6 list of 7\n"},
                      Example{"*SET_NODE_LIST_GENERATE_COLLECT\n7\n1,4,10,20\n", "node 1-4 range of 7\nnode 10-20 range of 7\n"},
                      Example{"*SET_SHELL_LIST_GENERATE_INCREMENT\n7\n1,9,4\n", "shell 1-9/4 range of 7\n"},
                      Example{"*SET_NODE_GENERAL\n7\nNODE,1,2\nDNODE,2\nPART,3\nBOX,9\n",
                              "node 1-2 list of 7\nnode 2 single of 7\npart 3 single of 7\n"},
                      Example{"*SET_NODE_LIST_GENERATE\n7\n1,2,4,5,7,8,10,12\n",
                              "node 1-2 range of 7\nnode 4-5 range of 7\nnode 7-8 range of 7\nnode 10-12 range of 7\n"},
                      Example{"*SET_NODE_LIST_GENERATE_INCREMENT\n7\n10,1,4\n", "node 2-10/4 range of 7\n"},
                      Example{"*SET_NODE_INTERSECT\n7\n1,2\n", "node set 1-2 list of 7\n"},
                      Example{"*SET_NODE_ADD\n7\n1,2\n", "node set 1-2 list of 7\n"},
                      Example{"*SET_PART_ADD\n7\n3,-6\n", "part set 3 list of 7\npart set 4-6 range of 7\n"},
                      Example{"*SET_SOLID_GENERAL\n7\nELEM,5\n", "solid 5 list of 7\n"}, Example{"*SET_BEAM\n7\n5\n", "beam 5 list of 7\n"},
                      Example{"*SET_TSHELL_COLLECT\n7\n5\n", "tshell 5 list of 7\n"},
                      Example{"*SET_DISCRETE\n7\n5\n", "discrete 5 list of 7\n"},
                      Example{"*SET_SEGMENT_TITLE\ntop\n7\n1,2,3,3\n",
                              "node 1 segment of 7\nnode 2 segment of 7\nnode 3 segment of 7\nnode 3 segment of 7\n"},
                      Example{"*PARAMETER\nIlow,4,Ihigh,8\n*SET_NODE_LIST_GENERATE\n7\n&low,&high\n", "node 4-8 range of 7\n"}));

INSTANTIATE_TEST_SUITE_P(
    Constraints, Cards,
    ::testing::Values(
        Example{"*BOUNDARY_SPC_NODE_ID\n5,left\n3,0,1\n6,right\n4,0,1\n", "node 3 single of 5\nnode 4 single of 6\n"},
        Example{"*BOUNDARY_SPC_SET_BIRTH_DEATH\n3,0,1\n0.0,1.0\n", "node set 3 single\n"},
        Example{"*BOUNDARY_PRESCRIBED_MOTION_RIGID\n3,1,0,5\n4,9,0,5\n0,0,6,7,8\n",
                "node 7 single\nnode 8 single\npart 3 single\npart 4 single\npart 6 single\n"},
        Example{"*CONSTRAINED_NODAL_RIGID_BODY_SPC\n9,0,3,4\n1,1,1\n10,0,5,6\n1,1,1\n",
                "node 4 single of 9\nnode 6 single of 10\nnode set 3 single of 9\nnode set 5 single of 10\n"},
        Example{"*CONSTRAINED_NODAL_RIGID_BODY_INERTIA\n9,0,3\n0,0,0,1.,1,8\n1.,0,0,1.,0,1.\n0,0,0\n0,0,0\n10,0,5\n0,0,0,1.\n1.\n0\n",
                "node 8 single of 9\nnode set 3 single of 9\nnode set 5 single of 10\n"},
        Example{"*CONSTRAINED_EXTRA_NODES_SET\n3,4\n", "part 3 single\nnode set 4 single\n"},
        Example{"*CONSTRAINED_RIGID_BODIES\n3,4\n5,6\n", "part 3 single\npart 4 single\npart 5 single\npart 6 single\n"},
        Example{"*CONSTRAINED_JOINT_REVOLUTE_FAILURE_ID\n8,hinge\n1,2,3,4\n0,0.1\n1.,1.\n",
                "node 1 single of 8\nnode 2 single of 8\nnode 3 single of 8\nnode 4 single of 8\n"},
        Example{"*CONSTRAINED_GENERALIZED_WELD_SPOT\n4\n\n5\n\n", "node set 4 single\nnode set 5 single\n"},
        Example{"*CONSTRAINED_GENERALIZED_WELD_CROSS_FILLET\n4,0,0,0,2\n\n1,2\n3,4\n5\n\n",
                "node 1 single\nnode 2 single\nnode 3 single\nnode 4 single\nnode set 4 single\nnode set 5 single\n"},
        Example{"*CONSTRAINED_SPOTWELD_ID\n8,weld\n1,2\n", "node 1 single of 8\nnode 2 single of 8\n"},
        Example{"*CONSTRAINED_INTERPOLATION\n8,1,0,0,1\n11\n12\n",
                "node 1 single of 8\nnode set 11 single of 8\nnode set 12 single of 8\n"},
        Example{"*CONSTRAINED_LAGRANGE_IN_SOLID\n3,4,1,0\n", "part 3 single\npart set 4 single\n"},
        Example{"*RIGIDWALL_PLANAR_FORCES_ID\n8,wall\n3,4\n0,0,0,0,0,1\n0,6,1\n",
                "node 1 single of 8\nnode set 3 single of 8\nnode set 4 single of 8\nsegment set 6 single of 8\n"},
        Example{"*DEFORMABLE_TO_RIGID\n3,4,PSET\n5\n", "part 4 single\npart 5 single\npart set 3 single\n"}));

INSTANTIATE_TEST_SUITE_P(
    Others, Cards,
    ::testing::Values(
        Example{"*CONTACT_AUTOMATIC_SURFACE_TO_SURFACE_MPP_ID\n8,all\n0,200\n&,1\n3,4,2,3\n0.1\n\n",
                "part 4 single of 8\npart set 3 single of 8\n"},
        Example{"*CONTACT_RIGID_BODY_ONE_WAY_TO_RIGID_BODY\n3,4,2,3\n", "part 4 single\npart set 3 single\n"},
        Example{"*CONTACT_TIED_NODES_TO_SURFACE\n3,4,4,0\n", "node set 3 single\nsegment set 4 single\n"},
        Example{"*CONTACT_AUTOMATIC_SINGLE_SURFACE_TITLE\n1,all\n0,0,5\n", ""},
        Example{"*DATABASE_HISTORY_NODE_ID\n         7the rim\n", "node 7 single\n"},
        Example{"*DATABASE_CROSS_SECTION_SET_ID\n8,cut\n1,2,3,4,5,6\n",
                "node set 1 single of 8\nshell set 4 single of 8\nbeam set 3 single of 8\nsolid set 2 single of 8\ntshell set 5 single of "
                "8\ndiscrete set 6 single of 8\n"},
        Example{"*LOAD_SEGMENT\n1,1.,0,1,2,3,4\n1,1.,0,5,6,7,8,9\n10,11,12\n",
                "node 1 single\nnode 2 single\nnode 3 single\nnode 4 single\nnode 5 single\nnode 6 single\nnode 7 single\nnode 8 "
                "single\nnode 9 "
                "single\nnode 10 single\nnode 11 single\nnode 12 single\n"},
        Example{"*LOAD_NODE_POINT\n1,3,5\n", "node 1 single\n"},
        Example{"*INITIAL_VELOCITY\n3,4\n0,0,1.\n0,0,2.\n5\n0,0,1.\n", "node set 3 single\nnode set 4 single\nnode set 5 single\n"},
        Example{"*INITIAL_VELOCITY_GENERATION\n3,2\n\n4,1\n\n", "part 3 single\npart set 4 single\n"},
        Example{"*INITIAL_STRESS_SHELL\n1,1,2,1\n-1.,0.,0.,0.,0.,0.,0.,0.\n0.5\n1.,0.,0.,0.,0.,0.,0.,0.\n0.5\n2,1,1\n0.,0.\n",
                "shell 1 single\nshell 2 single\n"},
        Example{"*SENSOR_DEFINE_NODE\n8,1,2\n", "node 1 single of 8\nnode 2 single of 8\n"},
        Example{"*DEFINE_COORDINATE_NODES_TITLE\naxes\n8,1,2,3\n", "node 1 single of 8\nnode 2 single of 8\nnode 3 single of 8\n"},
        Example{"*DEFINE_HEX_SPOTWELD_ASSEMBLY_4\n8\n1,2,3,4\n",
                "solid 1 single of 8\nsolid 2 single of 8\nsolid 3 single of 8\nsolid 4 single of 8\n"},
        Example{"*AIRBAG_SIMPLE_PRESSURE_VOLUME_ID\n8,bag\n3,1\n", "part set 3 single of 8\n"},
        Example{"*PART_INERTIA\nblock\n3,1,1\n0,0,0,1.,1,8\n1.\n0\n0\n*PART_MOVE\n       4             0.0             0.0            30.0 "
                "      0       1\n",
                "node 8 single of 3\npart set 4 single\n"},
        Example{"*DEFINE_TRANSFORMATION_TITLE\nt\n8\nROTATE3NA,1,2,0.,90.\nTRANSL2ND,4,5,6.\nMIRROR,7.,8.\n",
                "node 1 single\nnode 2 single\nnode 4 single\nnode 5 single\n"},
        Example{"*DEFINE_TRANSFORMATION\n8\nTRANSL,1.,2.,3.\nPOS6N,1,2,3,4,5,6\n",
                "node 1 single\nnode 2 single\nnode 3 single\nnode 4 single\nnode 5 single\nnode 6 single\n"},
        Example{
            "*MAT_ELASTIC\n1,2,3,4\n*DEFINE_CURVE\n1\n1,2\n*CONTROL_TERMINATION\n1\n*HOURGLASS\n1,2\n*DATABASE_GLSTAT\n1\n*TITLE\n1 2\n",
            ""}));

TEST(TextNobodyUnderstands, is_kept_apart) {
  for (const char* cards : {"*FOO\n1,2\n", "*SET_NODE_TREE\n1,2\n", "*CONTACT_2D_AUTOMATIC\n1,2\n", "*BOUNDARY_SPC_NODE_NEW_OPTION\n1\n",
                            "*BOUNDARY_SPC_NODE\nabc\n", "*CONTACT_TIED_NODES_TO_SURFACE\n1,2,9,0\n", "*INCLUDE_NASTRAN\nno.bdf\n"})
    EXPECT_EQ(read(cards).unread, 1u) << cards;
}

TEST(TextNobodyUnderstands, stands_in_the_way_of_what_it_may_name) {
  const DeckFolder folder;
  const auto opened = folder.open(std::string("*KEYWORD\n") + kTwoShellMesh + "*PARAMETER\nIn,4\n*FOO\n1,&n,x 7.5\n00000005" +
                                  "00000006\n*SET_NODE_LIST\n7\n8,2\n*END\n");
  ASSERT_OPENED(opened);
  DeletionCheck check(*opened->deck);
  for (const std::int64_t node : {1, 4, 5, 6}) {
    const Result<void> may = check.may_be_deleted(Referred::node, node);
    ASSERT_FALSE(may) << node;
    EXPECT_NE(may.error().message.find("*FOO"), std::string::npos) << may.error().text();
    EXPECT_GT(may.error().line, 0);
  }
  for (const std::int64_t node : {2, 3, 7, 8}) EXPECT_TRUE(check.may_be_deleted(Referred::node, node)) << node;
  EXPECT_EQ(what_names(*opened->deck, Referred::node, 8), std::vector<std::string>{"*SET_NODE_LIST 7 (deck.k:24)"});
}

TEST(EncryptedText, stands_in_the_way_of_all_removal) {
  const DeckFolder folder;
  const auto opened = folder.open(std::string("*KEYWORD\n") + kTwoShellMesh +
                                  "*SET_NODE_LIST\n7\n-----BEGIN PGP MESSAGE-----\nxyz\n-----END PGP MESSAGE-----\n1,2\n*END\n");
  ASSERT_OPENED(opened);
  ASSERT_EQ(opened->deck->references->unread().size(), 1u);
  EXPECT_TRUE(opened->deck->references->unread()[0].encrypted);
  EXPECT_TRUE(opened->deck->references->named(Referred::node, 2));
  EXPECT_FALSE(may_be_deleted(*opened->deck, Referred::node, 8));
  EXPECT_EQ(warning(*opened->deck, "encrypted").count, 1u);
}

TEST(EncryptedText, among_nodes_and_elements_stands_in_the_way_too) {
  const std::string armor = "-----BEGIN PGP MESSAGE-----\nxyz\n-----END PGP MESSAGE-----\n";
  for (const std::string& mesh : {"*NODE\n1,0,0,0\n" + armor + "2,1,0,0\n3,1,1,0\n*ELEMENT_SHELL\n1,1,1,2,3\n",
                                  "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n*ELEMENT_SHELL\n" + armor + "1,1,1,2,3\n"}) {
    const DeckFolder folder;
    const auto opened = folder.open("*KEYWORD\n" + mesh + "*PART\np\n1\n*END\n");
    ASSERT_OPENED(opened);
    ASSERT_EQ(opened->deck->references->unread().size(), 1u);
    const UnreadText& unread = opened->deck->references->unread()[0];
    EXPECT_TRUE(unread.encrypted);
    EXPECT_EQ(content(folder / "deck.k").substr(unread.begin, unread.end - unread.begin), armor);
    EXPECT_FALSE(may_be_deleted(*opened->deck, Referred::node, 3));
  }
}

TEST(EncryptedText, behind_the_mpp_line_of_a_contact_hides_no_surface) {
  const DeckFolder folder;
  const auto opened = folder.open(
      "*KEYWORD\n*CONTACT_AUTOMATIC_SURFACE_TO_SURFACE_MPP\n0,200\n-----BEGIN PGP MESSAGE-----\nxyz\n-----END PGP MESSAGE-----\n"
      "3,4,2,3\n*END\n");
  ASSERT_OPENED(opened);
  EXPECT_TRUE(opened->deck->references->named(Referred::part_set, 3));
  EXPECT_TRUE(opened->deck->references->named(Referred::part, 4));
}

TEST(GeneralSets, say_what_they_are_to_be_without) {
  const DeckFolder folder;
  const auto opened = folder.open("*KEYWORD\n*SET_NODE_GENERAL\n7\nNODE,1\nDNODE,2\nNODE,3\n*END\n");
  ASSERT_OPENED(opened);
  for (const Reference& reference : opened->deck->references->all()) EXPECT_EQ(reference.takes_away, reference.first == 2);
  EXPECT_EQ(opened->deck->references->all().size(), 3u);
}

TEST(CardsThatNameOneAlone, stand_in_the_way_and_lists_do_not) {
  const DeckFolder folder;
  const auto opened = folder.open(std::string("*KEYWORD\n") + kTwoShellMesh + "*BOUNDARY_SPC_NODE\n3\n*SET_SEGMENT\n5\n1,2,3,4\n*END\n");
  ASSERT_OPENED(opened);
  const Result<void> spc = may_be_deleted(*opened->deck, Referred::node, 3);
  ASSERT_FALSE(spc);
  EXPECT_EQ(spc.error().line, 18);
  EXPECT_NE(spc.error().message.find("*BOUNDARY_SPC_NODE names it"), std::string::npos);
  const Result<void> segment = may_be_deleted(*opened->deck, Referred::node, 4);
  ASSERT_FALSE(segment);
  EXPECT_NE(segment.error().message.find("a segment of *SET_SEGMENT 5"), std::string::npos);
  EXPECT_TRUE(may_be_deleted(*opened->deck, Referred::node, 6));
}

TEST(Offsets, of_a_transformed_include_count_for_what_its_cards_name) {
  const DeckFolder folder;
  folder.write("part.k", "*SET_NODE_LIST\n7\n1,2\n*CONSTRAINED_EXTRA_NODES_SET\n3,7\n*SET_SHELL\n8\n5\n*END\n");
  const auto opened = folder.open("*KEYWORD\n*INCLUDE_TRANSFORM\npart.k\n1000,2000,3000,0,500,0,0\n0\n1.,1.,1.\n0\n*END\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(references_of(*opened->deck), "node 1001-1002 list of 507\nshell 2005 list of 508\npart 3003 single\nnode set 507 single\n");
}

TEST(HostileCards, cost_no_more_than_their_text) {
  std::string cards =
      "*SET_NODE_LIST_GENERATE\n1\n1,999999999999999999,-5,7\n9,2,0,0\n99999999999999999999,1\n*SET_NODE_LIST_GENERATE_INCREMENT\n2\n1,"
      "999999999999999999,-3\n9,1,-4\n"
      "*CONSTRAINED_GENERALIZED_WELD_CROSS_FILLET\n4,0,0,0,999999999999999999\n\n1,2\n*CONSTRAINED_GENERALIZED_WELD_COMBINED\n4,0,0,0,"
      "999999999999999999\n";
  cards += "*SET_SEGMENT\n*SET_NODE_LIST_TITLE\n*PART\n*CONTACT_TIED_NODES_TO_SURFACE_MPP_ID\n1\n";
  cards += "*SET_NODE_COLUMN\n3\n";
  for (int i = 0; i < 1000000; ++i) cards += i % 2 ? "1\n" : "3\n";
  const DeckFolder folder;
  const auto opened = folder.open("*KEYWORD\n" + std::string(kTwoShellMesh) + cards + "*END\n");
  ASSERT_OPENED(opened);
  EXPECT_TRUE(opened->deck->references->named(Referred::node, 8));
  EXPECT_EQ(opened->deck->references->naming(Referred::node, 1).size(), 500005u);
}

// --- real decks -----------------------------------------------------------------------------------------------------

class RealReferences : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* models = std::getenv("PRISMESH_MODELS");
    if (!models) {
      std::cout << "PRISMESH_MODELS doesn't point to the real decks: THE TESTS ON THEM ARE SKIPPED\n";
      GTEST_SKIP();
    }
    models_ = models;
  }
  /// How many ids the card of a keyword and id names.
  static std::size_t named_by(const Deck& deck, std::string_view keyword, std::int64_t id) {
    std::size_t count = 0;
    for (const Reference& r : deck.references->all()) {
      const Referrer& card = deck.references->referrers()[r.referrer];
      if (card.keyword == keyword && card.id == id) count += static_cast<std::size_t>((r.last - r.first) / r.step + 1);
    }
    return count;
  }
  static std::size_t cards(const Deck& deck, std::string_view keyword) {
    std::size_t count = 0;
    for (const Reference& r : deck.references->all()) count += deck.references->referrers()[r.referrer].keyword == keyword;
    return count;
  }
  std::filesystem::path models_;
};

TEST_F(RealReferences, are_as_many_as_counted_by_hand) {
  const auto hat = deck::open(models_ / "hatprofile/Hatprofile.k");
  ASSERT_OPENED(hat);
  EXPECT_EQ(named_by(*hat->deck, "SET_NODE_LIST_TITLE", 1), 1616u);
  const std::vector<Reference> naming = hat->deck->references->naming(Referred::shell, 4700019);
  ASSERT_EQ(naming.size(), 1u);
  EXPECT_EQ(naming[0].first, 4700000);
  EXPECT_EQ(naming[0].last, 4799999);
  EXPECT_EQ(naming[0].role, ReferenceRole::range);
  EXPECT_TRUE(hat->deck->references->named(Referred::shell, 1002198));
  EXPECT_TRUE(hat->deck->references->named(Referred::part, 9));

  const auto car = deck::open(models_ / "gsa_car6_comma/car6_crash.k");
  ASSERT_OPENED(car);
  EXPECT_EQ(cards(*car->deck, "CONSTRAINED_GENERALIZED_WELD_SPOT"), 3u);
  EXPECT_EQ(named_by(*car->deck, "SET_NODE_LIST", 1), 151u);
  EXPECT_EQ(named_by(*car->deck, "SET_NODE_LIST", 2), 221u);
  EXPECT_EQ(cards(*car->deck, "INITIAL_VELOCITY_NODE"), 758u);
  EXPECT_TRUE(car->deck->references->named(Referred::node_set, 6));

  const auto bolt = deck::open(models_ / "bolt_a_missing_include/mainboltaexpl.k");
  ASSERT_OPENED(bolt);
  const References& of_bolt = *bolt->deck->references;
  EXPECT_TRUE(of_bolt.defined(Referred::part, 110));
  EXPECT_TRUE(of_bolt.defined(Referred::part, 120));
  EXPECT_TRUE(of_bolt.named(Referred::node_set, 110));
  EXPECT_EQ(named_by(*bolt->deck, "SET_NODE_LIST_TITLE", 110), 49u);
  EXPECT_EQ(named_by(*bolt->deck, "SET_NODE_LIST_TITLE", 120), 21u);
  EXPECT_EQ(named_by(*bolt->deck, "SET_NODE_LIST_TITLE", 10), 45u);
  EXPECT_TRUE(of_bolt.named(Referred::beam, 1000000));

  const auto ball = deck::open(models_ / "birdball/birdball.k");
  ASSERT_OPENED(ball);
  EXPECT_EQ(named_by(*ball->deck, "SET_NODE_LIST_GENERATE", 1), 376u);
  EXPECT_EQ(cards(*ball->deck, "INITIAL_VELOCITY_NODE"), 1281u);
}

TEST_F(RealReferences, leave_no_keyword_unread_that_was_not_looked_at) {
  // What these say besides what the table reads names no node or element.
  const std::set<std::string> looked_at{"AIRBAG_WANG_NEFSKE_ID", "FREQUENCY_DOMAIN_SSD"};
  for (const char* main :
       {"belted_dummy/belted_dummy.k", "bird_strike_composite/input.k", "birdball/birdball.k", "gsa_car6_comma/car6_crash.k",
        "gsa_car6_v3_param/main_v223_param.k", "hatprofile/Hatprofile.k", "joint_screw/EXP_SC_JOINT_SCREW.key", "jp_test_k/test.k",
        "pillars_open_airbag_v135/open_airbag_v135.k", "wheel_k/wheel.k", "wing_ferig/main.k", "camry_weld7_beams/weld7.k",
        "camry_roof_welds/roof_welds.k", "bolt_a_missing_include/mainboltaexpl.k"}) {
    const auto opened = deck::open(models_ / main);
    ASSERT_OPENED(opened);
    for (const UnreadText& unread : opened->deck->references->unread())
      EXPECT_TRUE(looked_at.contains(unread.keyword)) << main << ": *" << unread.keyword;
  }
}

}  // namespace
}  // namespace prismesh::mesh::deck
