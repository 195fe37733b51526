// What isn't a deck, or is a broken one: one clear sentence with file and line, and no harm done.
#include <ctime>
#include <thread>

#include "mesh/deck/open.h"
#include "mesh/deck/save.h"
#include "tests/mesh/deck/deck_files.h"

namespace prismesh::mesh::deck {
namespace {

/// Processor time of this process: a loaded machine doesn't lengthen it.
double cpu_s() {
  timespec used{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * 1e-9;
}

void expect_error(const Result<OpenedDeck>& opened, long line, std::string_view words) {
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().file.find("deck.k"), std::string::npos);
  EXPECT_EQ(opened.error().line, line) << opened.error().text();
  EXPECT_NE(opened.error().message.find(words), std::string::npos) << opened.error().text();
}

TEST(BadInput, not_there_or_a_folder) {
  const DeckFolder folder;
  expect_error(deck::open(folder / "deck.k"), 0, "can't be opened: No such file");
  std::filesystem::create_directory(folder / "deck.k");
  expect_error(deck::open(folder / "deck.k"), 0, "is a folder");
}

TEST(BadInput, says_what_it_looks_like) {
  const DeckFolder folder;
  const std::pair<std::string, std::string> cases[] = {
      {"", "an empty file"},
      {" \n\n", "an empty file"},
      {"Dear all,\nplease find attached\n", "text without a single keyword"},
      {std::string("PK\x03\x04zip", 7), "a ZIP archive"},
      {"\x1f\x8b\x07gz", "a gzip file"},
      {"%PDF-1.4", "a PDF document"},
      {"solid part\n facet normal 0 0 1\n", "an STL file"},
      {std::string(1000, '\0'), "a binary file"},
      {"\xff\xfe*\0N\0", "UTF-16"},
      {"*KEYWORD\r*NODE\r1,0.,0.,0.\r*END\r", "carriage returns alone"},
      {std::string("*NODE\n1,\0,1.,1.\n", 16) + std::string(100, '*'), "a text with NUL bytes"}};
  for (const auto& [text, words] : cases) expect_error(folder.open(text), 0, words);
}

TEST(BadInput, cards_that_cant_be_read_are_named) {
  const DeckFolder folder;
  expect_error(folder.open("*KEYWORD\n*NODE\n       1             1.0\n       2             abc             0.0\n*END\n"), 4,
               "expected the x coordinate of node 2 but found \"abc\"");
  expect_error(folder.open("*NODE\n       x             1.0\n"), 2, "expected a node id but found \"x\"");
  expect_error(folder.open("*NODE\n      -5             1.0\n"), 2, "a node needs an id above 0");
  expect_error(folder.open("*NODE\n                     1.0\n"), 2, "a node needs an id above 0");
  expect_error(folder.open("*NODE\n1,0.,1.2.3,0.\n"), 2, "expected the y coordinate of node 1 but found \"1.2.3\"");
  expect_error(folder.open("*NODE\n1,0.,0.,1e999\n"), 2, "the z coordinate");
  expect_error(folder.open("*NODE\n1,0.,0.,0.\n*ELEMENT_SHELL\n       1       1       1       y       1\n"), 4, "found \"y\"");
  expect_error(folder.open("*ELEMENT_SOLID\n       1       1\n       1   &&*()       3\n*NODE\n1,0.,0.,0.\n*ELEMENT_MASS\nm,1\n"), 7,
               "found \"m\"");
}

TEST(BadInput, an_error_in_an_include_names_the_include) {
  const DeckFolder folder;
  folder.write("inc.k", "*NODE\n\n1,zero\n");
  const auto opened = folder.open("*INCLUDE\ninc.k\n");
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().file.find("inc.k"), std::string::npos);
  EXPECT_EQ(opened.error().line, 3);
}

TEST(BadInput, a_cut_off_deck_is_warned_of) {
  const DeckFolder folder;
  const auto opened = folder.open("*KEYWORD\n*NODE\n       1             1.0\n");
  ASSERT_OPENED(opened);
  EXPECT_EQ(warning(*opened->deck, "no-end").count, 1u);
}

TEST(BadInput, encrypted_blocks_pass_through) {
  const DeckFolder folder;
  const std::string armor = "-----BEGIN PGP MESSAGE-----\nVersion: 1\n\njA0ECQMC7x3\n*=2Fab\n-----END PGP MESSAGE-----\n";
  std::string body = armor;
  body.erase(body.find("*=2Fab\n"), 7);
  const std::string text = "*KEYWORD\n*NODE\n       1             1.0\n" + body + "       2             2.0\n*ELEMENT_SHELL\n" + body +
                           "       1       1       1       2       3\n*NODE\n3,3.,0.,0.\n*END\n";
  const auto opened = folder.open(text);
  ASSERT_OPENED(opened);
  EXPECT_EQ(opened->model.node_count(), 3u);
  EXPECT_EQ(opened->model.shell_count(), 1u);
  ASSERT_TRUE(save(*opened->deck, opened->model, opened->model, folder / "out/deck.k"));
  EXPECT_EQ(content(folder / "out/deck.k"), text);
  const auto open_ended = folder.open("*NODE\n1,1.,0.,0.\n-----BEGIN PGP MESSAGE-----\nabc\n*END\n");
  ASSERT_OPENED(open_ended);
  EXPECT_EQ(open_ended->model.node_count(), 1u);
}

TEST(BadInput, hostile_text_is_read_in_bounded_time_and_memory) {
  const DeckFolder folder;
  const std::string cases[] = {
      "*KEYWORD\n*NODE\n" + std::string(10 << 20, '1') + "\n*END\n",
      "*KEYWORD\n*NODE\n" + std::string(10 << 20, ',') + "\n*END\n",
      "*KEYWORD\n" + std::string(10 << 20, '*') + "\n*END\n",
      "*KEYWORD\n*INCLUDE\n" + std::string(1 << 20, 'x') + "\n*END\n",
      "*KEYWORD\n*PARAMETER_EXPRESSION\nR       a (" + std::string(1 << 20, '(') + "\n*END\n",
      "*KEYWORD\n*NODE\n" + std::string(1 << 20, '\0') + "\n*END\n",
      "*KEYWORD\n*SECTION_SHELL\n         1         2       0.0   9.9E+99                   1\n*CONTROL_TIMESTEP\n "
      "1e300,1e300,9e17\n*END\n",
  };
  for (const std::string& text : cases) {
    const double start_s = cpu_s();
    const auto opened = folder.open(text);
    EXPECT_TRUE(opened || !opened.error().message.empty());
    EXPECT_LT(cpu_s() - start_s, 10) << text.substr(0, 40);
  }
  std::string blocks = "*KEYWORD\n", parameters = "*KEYWORD\n", includes = "*KEYWORD\n*INCLUDE_PATH\n";
  for (int i = 0; i < 100000; ++i) {
    blocks += "*NODE\n";
    parameters += "*PARAMETER\nRa" + std::to_string(i) + ",1.\n*NODE\n" + std::to_string(i + 1) + ",&a" + std::to_string(i) + "\n";
  }
  for (int i = 0; i < 200; ++i) includes += "p" + std::to_string(i) + "\n";
  for (int i = 0; i < 3000; ++i) includes += "*INCLUDE\ngone" + std::to_string(i % 1000) + "\n*INCLUDE\ndeck.k\n";
  const double start_s = cpu_s();
  EXPECT_TRUE(folder.open(blocks + "*END\n"));
  const auto many = folder.open(parameters + "*END\n");
  ASSERT_OPENED(many);
  EXPECT_EQ(many->model.node_count(), 100000u);
  EXPECT_TRUE(folder.open(includes + "*END\n"));
  EXPECT_LT(cpu_s() - start_s, 20);
}

struct Hostile {
  const char* name;  ///< the main file's
  std::string text;
  std::string said;  ///< words of the error or of a warning
};

std::string repeated(std::string_view text, std::size_t times) {
  std::string out;
  for (std::size_t i = 0; i < times; ++i) out += text;
  return out;
}

/// What the deck's error or warnings say, the places where they say it included.
std::string all_said(const Result<OpenedDeck>& opened) {
  if (!opened) return opened.error().text();
  std::string said;
  for (const Warning& warning : opened->deck->warnings) said += Error{warning.file, warning.line, warning.message}.text() + "\n";
  return said;
}

TEST(BadInput, of_every_format_is_named_by_file_and_line_in_bounded_time) {
  const std::string grid = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nCTRIA3,1,1,1,2,3\n";
  const std::string bulk = "BEGIN BULK\n" + grid;
  const std::string rad = "#RADIOSS STARTER\n/BEGIN\nx\n      2022         0\n";
  const std::string inp = "*NODE\n1,0.,0.,0.\n2,1.,0.,0.\n3,1.,1.,0.\n*ELEMENT,TYPE=S3,ELSET=E\n1,1,2,3\n";
  std::string chain = "BEGIN BULK\n";
  for (int i = 0; i < 20000; ++i) chain += "CORD2R," + std::to_string(i + 1) + "," + std::to_string(i) + ",1.,0.,0.,1.,0.,1.,\n,2.,0.,0.\n";
  const Hostile cases[] = {
      {"d.bdf", "BEGIN BULK\nGRID,1,,0.,0.,0.\n=,*(1),=,*(1.),==\n=(999999999)\nENDDATA\n", "d.bdf:4: the replications"},
      {"d.bdf", bulk + "CTRIA3,2,1,1,2,3\n=,*(1),==\n=(2000000000)\nENDDATA\n", "d.bdf:8: the replications"},
      {"d.bdf", bulk + "SPC1,1,123,1,THRU,1000000000000000000\nSPOINT,1,THRU,999999999999999999\nENDDATA\n", ""},
      {"d.bdf", "CORD2R,1,2,0.,0.,0.,0.,0.,1.,\n,1.,0.,0.\nCORD2R,2,1,0.,0.,0.,0.,0.,1.,\n,1.,0.,0.\nGRID,1,1,1.,1.,1.\n",
       "stands on itself"},
      {"d.bdf", chain + "GRID,1,20000,1.,1.,1.\n", ""},
      {"d.bdf", bulk + "RBE2,9,1,123,2\n" + repeated("+,3,3,3,3,3,3,3,3\n", 50000), ""},
      {"d.bdf", bulk + std::string(4 << 20, '1') + "\nENDDATA\n", ""},
      {"d.bdf", bulk + "INCLUDE '" + repeated("x\n", 100000) + "'\nENDDATA\n", "d.bdf:6: the quote before the include file's name"},
      {"d.bdf", bulk + "INCLUDE 'd.bdf'\nINCLUDE 'sub'\nENDDATA\n", "d.bdf:7: the include file sub is a folder"},
      {"d.bdf", bulk + "CROD,2,1,1,9\nGRID,9,,abc,0.,0.\n", "d.bdf:7: expected coordinate 1 of GRID 9 but found \"abc\""},
      {"d.bdf", bulk + "CQUAD1,9,1,1,2,3,3\n", "d.bdf:6: CQUAD1"},
      {"d_0000.rad", rad + "#include d_0000.rad\n#include sub\n/END\n", "d_0000.rad:6: the include file sub is a folder"},
      {"d_0000.rad", rad + repeated("//SUBMODEL/1\nx\n", 50000) + "/END\n", "submodels stand in each other more than 64 deep"},
      {"d_0000.rad", rad + "/NODE\n" + std::string(4 << 20, '1') + "\n/END\n", ""},
      {"d_0000.rad", rad + "/NODE\n         x                 1.0\n/END\n", "d_0000.rad:6: expected a node id"},
      {"d_0000.rad", rad + "/\n//\n///\n/NODE/\n/SHELL/\n/SHELL/x\n/PART/\n/PART/-1\n/END\n", ""},
      {"d.inp", inp + "*INCLUDE,INPUT=d.inp\n*INCLUDE,INPUT=sub\n", "d.inp:8: the include file sub is a folder"},
      {"d.inp", inp + "*NSET,NSET=X,GENERATE\n1,1000000000000000000,1\n*ELSET,ELSET=Y,GENERATE\n1,999999999999,1\n", ""},
      {"d.inp", inp + "*ELSET,ELSET=P\nQ\n*ELSET,ELSET=Q\nP\n*SHELL SECTION,ELSET=P,MATERIAL=M\n1.\n", ""},
      {"d.inp", inp + "*NODE\n1000000000,0.,0.,0.\n2000000000,1.,0.,0.\n*NGEN\n1000000000,2000000000,1\n", "d.inp:10: *NGEN"},
      {"d.inp", inp + "*NODE\n" + std::string(4 << 20, '1') + "\n", "d.inp:8: expected a node number"},
      {"d.inp", inp + "*NODE\n" + std::string(4 << 20, ',') + "\n", ""},
      {"d.inp", inp + repeated("*NSET,\n", 100000), ""},
      {"d.inp", inp + "*ELEMENT,TYPE=C3D20,ELSET=S\n9," + repeated("1,\n", 200000), "fewer nodes than its kind needs"},
  };
  const DeckFolder folder;
  std::filesystem::create_directory(folder / "sub");
  for (const auto& [name, text, said] : cases) {
    SCOPED_TRACE(text.substr(0, 60) + " ... " + text.substr(text.size() - std::min<std::size_t>(text.size(), 60)));
    const double start_s = cpu_s();
    const auto opened = deck::open(folder.write(name, text));
    EXPECT_LT(cpu_s() - start_s, 10);
    EXPECT_NE(all_said(opened).find(said), std::string::npos) << all_said(opened);
    if (!opened) {
      EXPECT_FALSE(said.empty()) << opened.error().text();
      continue;
    }
    const auto saved = save(*opened->deck, opened->model, opened->model, folder / "out" / name);
    ASSERT_TRUE(saved) << saved.error().text();
    EXPECT_EQ(content(folder / "out" / name), text);
  }
}

TEST(Progress, goes_up_and_stops_when_told) {
  const DeckFolder folder;
  std::string text = "*NODE\n";
  for (int i = 1; i < 60000; ++i) text += std::to_string(i) + ",1.,2.,3.,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n";
  const auto path = folder.write("deck.k", text);
  std::vector<double> told;
  const auto thread = std::this_thread::get_id();
  const auto opened = deck::open(path, [&](double fraction) {
    EXPECT_EQ(std::this_thread::get_id(), thread);
    told.push_back(fraction);
    return true;
  });
  ASSERT_OPENED(opened);
  ASSERT_GE(told.size(), 3u);
  EXPECT_EQ(told.front(), 0.0);
  EXPECT_EQ(told.back(), 1.0);
  for (std::size_t stop_at = 0; stop_at < 4; ++stop_at) {
    std::size_t calls = 0;
    const auto stopped = deck::open(path, [&](double) { return calls++ < stop_at; });
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().message, cancelled().message);
  }
}

}  // namespace
}  // namespace prismesh::mesh::deck
