// Whole imports: the program is started, reads a deck in its sandbox, and hands it over.
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ipc/import/client.h"
#include "ipc/import/text_hand_over.h"
#include "mesh/deck/editing/text_changes.h"
#include "mesh/deck/open.h"
#include "mesh/deck/sample.h"
#include "mesh/model/topology_change.h"
#include "tests/support/places.h"
#include "tests/support/real_deck.h"

namespace prismesh::importer {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string node_card(int id, double x, double y) {
  char text[96];
  std::snprintf(text, sizeof text, "%8d%16.6f%16.6f%16.6f\n", id, x, y, 0.0);
  return text;
}

/// `count` nodes from `first` on, in a row.
std::string nodes_from(int first, int count) {
  std::string text = "*NODE\n";
  for (int i = 0; i < count; ++i) text += node_card(first + i, i % 2, i / 2);
  return text;
}

const std::string kShell = "*ELEMENT_SHELL\n       1       1       1       2       4       3\n";

class Importing : public ::testing::Test {
 protected:
  void SetUp() override {
    root = fs::temp_directory_path() / ("prismesh-import-" + std::to_string(std::random_device{}()));
    folder = root / "upload";
    fs::create_directories(folder);
    options.program = test::programs_folder() / "prismesh-import";
  }
  void TearDown() override { fs::remove_all(root); }

  fs::path write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << text;
    return folder / name;
  }
  fs::path write_packed(const std::string& name, const std::string& text) const {
    gzFile file = ::gzopen((folder / name).c_str(), "wb9");
    ::gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
    ::gzclose(file);
    return folder / name;
  }
  Result<ipc::ImportedDeck> import(const fs::path& deck) const { return ipc::import_deck(deck, options); }
  std::string refusal(const fs::path& deck) const {
    const auto imported = import(deck);
    return imported ? "it was opened" : imported.error().text();
  }
  /// The warning about an include that isn't read.
  std::string warning(const std::string& include) const {
    const auto imported = import(write("main.k", "*KEYWORD\n*INCLUDE\n" + include + "\n" + nodes_from(1, 4) + kShell + "*END\n"));
    if (!imported) return imported.error().text();
    EXPECT_EQ(imported->opened.deck->files.size(), 1u);
    for (const mesh::deck::Warning& each : imported->opened.deck->warnings)
      if (each.kind == "missing-include") return each.message;
    return "no warning";
  }

  fs::path root;
  fs::path folder;
  ipc::ImportOptions options;
};

TEST_F(Importing, gives_what_reading_without_a_sandbox_gives) {
  write("parts/inner.k", nodes_from(3, 2));
  const fs::path deck = write("main.k", "*KEYWORD\n*INCLUDE\nparts/inner.k\n" + nodes_from(1, 2) + kShell +
                                            "*SET_NODE_LIST\n         5\n         1         2\n*END\n");
  const auto imported = import(deck);
  const auto opened = mesh::deck::open(deck);
  ASSERT_TRUE(imported) << imported.error().text();
  ASSERT_TRUE(opened);
  EXPECT_THAT(imported->unguarded, testing::IsEmpty());
  EXPECT_EQ(imported->opened.model.node_count(), 4u);
  EXPECT_EQ(imported->opened.model.shell_count(), 1u);
  ASSERT_EQ(imported->opened.deck->files.size(), 2u);
  EXPECT_EQ(imported->opened.deck->files[1].path, folder / "parts/inner.k");
  EXPECT_EQ(imported->opened.deck->files[1].bytes.text(), opened->deck->files[1].bytes.text());
  EXPECT_EQ(imported->opened.deck->content, opened->deck->content);
  EXPECT_EQ(imported->opened.deck->references->naming(mesh::Referred::node, 2).size(), 1u);
}

TEST_F(Importing, tells_of_its_progress) {
  ASSERT_TRUE(mesh::deck::write_sample(folder / "sample.k", 20'000));
  std::vector<double> heard;
  options.progress = [&](double fraction) {
    heard.push_back(fraction);
    return true;
  };
  ASSERT_TRUE(import(folder / "sample.k"));
  EXPECT_TRUE(std::is_sorted(heard.begin(), heard.end()));
  EXPECT_EQ(heard.front(), 0);
  EXPECT_GT(heard.back(), 0.5);
  EXPECT_LE(heard.back(), 1);
}

TEST_F(Importing, reads_a_deck_in_the_working_folder) {
  write("main.k", "*KEYWORD\n*INCLUDE\ninner.k\n" + kShell + "*END\n");
  write("inner.k", nodes_from(1, 4));
  const fs::path before = fs::current_path();
  fs::current_path(folder);
  const auto imported = import("main.k");
  fs::current_path(before);
  ASSERT_TRUE(imported) << imported.error().text();
  EXPECT_EQ(imported->opened.deck->files.at(1).relative, "inner.k");
}

TEST_F(Importing, refuses_includes_elsewhere_by_name) {
  std::ofstream(root / "secret.k") << nodes_from(100, 4);
  fs::create_directories(root / "upload2");
  std::ofstream(root / "upload2" / "secret.k") << nodes_from(100, 4);
  fs::create_symlink(root / "secret.k", folder / "link.k");
  fs::create_directory_symlink(root, folder / "linked");
  const auto refused = AllOf(HasSubstr("leads out"), HasSubstr("aren't read"));
  EXPECT_THAT(warning("../secret.k"), AllOf(HasSubstr("../secret.k"), refused));
  EXPECT_THAT(warning("../upload2/secret.k"), refused);
  EXPECT_THAT(warning("..\\secret.k"), refused);
  EXPECT_THAT(warning("./../upload/../secret.k"), refused);
  EXPECT_THAT(warning("link.k"), AllOf(HasSubstr("link.k"), refused));
  EXPECT_THAT(warning("linked/secret.k"), refused);
  const auto absolute = HasSubstr("absolute name");
  EXPECT_THAT(warning((root / "secret.k").string()), absolute);
  EXPECT_THAT(warning("/etc/passwd"), AllOf(HasSubstr("/etc/passwd"), absolute));
  EXPECT_THAT(warning("\\etc\\passwd"), absolute);
  EXPECT_THAT(warning("/proc/self/root/etc/passwd"), absolute);
  EXPECT_THAT(warning("../../../../../../../../proc/self/environ"), refused);
  EXPECT_THAT(warning("none.k"), HasSubstr("isn't there"));
}

TEST_F(Importing, reads_no_main_file_through_a_link) {
  std::ofstream(root / "secret.k") << "*KEYWORD\n" << nodes_from(100, 4);
  fs::create_symlink(root / "secret.k", folder / "main.k");
  EXPECT_THAT(refusal(folder / "main.k"), AllOf(HasSubstr("main.k"), HasSubstr("through a link")));
}

TEST_F(Importing, doesnt_hang_on_a_pipe) {
  ASSERT_EQ(::mkfifo((folder / "pipe.k").c_str(), 0600), 0);
  EXPECT_THAT(refusal(folder / "pipe.k"), HasSubstr("not a regular file"));
}

TEST_F(Importing, says_what_is_wrong_with_a_deck) {
  EXPECT_THAT(refusal(write("none.k", "nothing\n")), AllOf(HasSubstr("none.k"), HasSubstr("is no deck")));
  EXPECT_THAT(refusal(folder / "absent.k"), HasSubstr("No such file"));
  EXPECT_THAT(refusal(folder / "no_folder" / "main.k"), HasSubstr("its folder can't be opened"));
}

TEST_F(Importing, holds_the_limits_of_a_deck) {
  options.limits = {std::uint64_t{4} << 30, 60, 2, 1 << 20, 10, 5};
  EXPECT_THAT(refusal(write("nodes.k", "*KEYWORD\n" + nodes_from(1, 11) + "*END\n")), AllOf(HasSubstr("nodes.k"), HasSubstr("10 nodes")));
  std::string shells = "*KEYWORD\n" + nodes_from(1, 4) + "*ELEMENT_SHELL\n";
  for (int id = 1; id <= 6; ++id) shells += "       " + std::to_string(id) + "       1       1       2       4       3\n";
  EXPECT_THAT(refusal(write("shells.k", shells + "*END\n")), AllOf(HasSubstr("shells.k"), HasSubstr("5 elements")));
  write("a.k", nodes_from(1, 2));
  write("b.k", nodes_from(3, 2));
  EXPECT_THAT(refusal(write("files.k", "*KEYWORD\n*INCLUDE\na.k\n*INCLUDE\nb.k\n*END\n")),
              AllOf(HasSubstr("b.k"), HasSubstr("the 2 that")));
  EXPECT_THAT(refusal(write("long.k", "*KEYWORD\n" + std::string(1 << 20, '$') + "\n*END\n")),
              AllOf(HasSubstr("long.k"), HasSubstr("1048576")));
}

TEST_F(Importing, stops_unpacking_at_the_limit) {
  options.limits.text_bytes = 8 << 20;
  std::string text = "*KEYWORD\n";
  std::mt19937 random(1);
  // It packs badly enough not to look as if it was made to exhaust memory.
  while (text.size() < (9u << 20)) text += "$ " + std::to_string(random()) + std::string(400, ' ') + "\n";
  EXPECT_THAT(refusal(write_packed("bomb.k.gz", text)), AllOf(HasSubstr("bomb.k.gz"), HasSubstr("8388608")));
  EXPECT_THAT(refusal(write("main.k", "*KEYWORD\n*INCLUDE\nbomb.k.gz\n*END\n")), AllOf(HasSubstr("bomb.k.gz"), HasSubstr("8388608")))
      << "an include too refuses the deck";
  EXPECT_THAT(refusal(write_packed("zeros.k.gz", std::string(64 << 20, '\n'))),
              AllOf(HasSubstr("zeros.k.gz"), HasSubstr("unpacks to more")));
}

#if !defined(PRISMESH_ADDRESS_SANITIZER)
TEST_F(Importing, says_that_memory_has_run_out) {
  options.limits.memory_bytes = std::uint64_t{200} << 20;
  std::string text = "*KEYWORD\n*NODE\n";
  while (text.size() < (120u << 20)) text += std::string(100'000, '$') + "\n";
  EXPECT_THAT(refusal(write("large.k", text)), AllOf(HasSubstr("large.k"), HasSubstr("memory")));
}
#endif

/// The deck of Importing with what an edit made of its model: a node moved, a shell removed, a node and a shell added.
class Rewriting : public Importing {
 protected:
  void SetUp() override {
    Importing::SetUp();
    write("parts/inner.k", nodes_from(3, 4) + "*ELEMENT_SHELL\n       2       1       3       4       6       5\n");
    deck = write("main.k", "*KEYWORD\n*INCLUDE\nparts/inner.k\n" + nodes_from(1, 2) + kShell + "*END\n");
    auto imported = import(deck);
    ASSERT_TRUE(imported) << imported.error().text();
    opened = std::move(imported->opened);
    model = opened.model;
    model.positions.set(model.find_node(3).value, {0.25, 1, 0});
    const mesh::NodeIndex middle = mesh::add_node(model, 20, {0.5, 0, 0}, mesh::edge_origin(model.find_node(1), model.find_node(2)));
    const mesh::ShellIndex first = model.find_shell(1);
    mesh::add_shell(model, 21, {{middle, model.find_node(2), model.find_node(4), model.find_node(4)}}, first);
    mesh::set_shell_nodes(model, first, {{model.find_node(1), middle, model.find_node(4), model.find_node(3)}});
    mesh::remove_shell(model, model.find_shell(2));
  }
  Result<mesh::deck::TextChanges> rewritten() const { return ipc::rewrite_deck(*opened.deck, opened.model, model, options); }

  fs::path deck;
  mesh::deck::OpenedDeck opened;
  mesh::Model model;
};

TEST_F(Rewriting, makes_the_text_that_is_made_without_a_sandbox) {
  const auto here = mesh::deck::text_changes(*opened.deck, opened.model, model);
  ASSERT_TRUE(here) << here.error().text();
  const auto there = rewritten();
  ASSERT_TRUE(there) << there.error().text();
  EXPECT_EQ(ipc::write_text_hand_over(*there), ipc::write_text_hand_over(*here));
  EXPECT_EQ(there->counts.nodes_added, 1u);
  EXPECT_EQ(there->counts.shells_removed, 1u);
  EXPECT_EQ(there->by_file.size(), 2u);
}

TEST_F(Rewriting, refuses_what_cant_be_saved_and_what_changed_on_disk) {
  mesh::remove_node(model, model.find_node(1));
  EXPECT_THAT(rewritten().error().text(), HasSubstr("node 1"));
  write("parts/inner.k", nodes_from(3, 5));
  EXPECT_THAT(rewritten().error().text(), HasSubstr("has changed on disk since it was opened"));
  fs::remove_all(folder);
  EXPECT_THAT(rewritten().error().text(), HasSubstr("folder can't be opened"));
}

/// Larger ones take the time of the suite, and have no card that the smaller ones lack.
constexpr std::uintmax_t kSmallDeckBytes = 8 << 20;

TEST_F(Importing, rewrites_real_decks_as_without_a_sandbox) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS names no folder with counts.json: REAL DECKS ARE NOT TESTED";
  std::ifstream in(*decks / "counts.json");
  const nlohmann::json counts = nlohmann::json::parse(in);
  std::size_t same = 0;
  for (const auto& [name, expected] : counts.items()) {
    const fs::path deck = *decks / expected["main"].get<std::string>();
    if (fs::file_size(deck) > kSmallDeckBytes) continue;
    const auto imported = import(deck);
    if (!imported) continue;
    const mesh::deck::OpenedDeck& opened = imported->opened;
    mesh::Model model = opened.model;
    for (std::size_t n = 0; n < model.node_count(); n += 5)
      if (model.node_holds[n] == 0) model.positions.set(n, model.positions[n] + mesh::Vec3(0.125, 0, 0.0625));
    if (model.shell_count() > 0) mesh::remove_shell(model, mesh::ShellIndex(model.shell_count() / 2));
    const auto here = mesh::deck::text_changes(*opened.deck, opened.model, model);
    const auto there = ipc::rewrite_deck(*opened.deck, opened.model, model, options);
    ASSERT_EQ(here.has_value(), there.has_value()) << name;
    if (here)
      EXPECT_EQ(ipc::write_text_hand_over(*there), ipc::write_text_hand_over(*here)) << name;
    else
      EXPECT_EQ(there.error().text(), here.error().text()) << name;
    same += here.has_value() ? 1 : 0;
  }
  EXPECT_GT(same, 10u);
}

/// A script in place of prismesh-import.
class ImportScript : public Importing {
 protected:
  void become(const std::string& script) {
    options.program = root / "script";
    std::ofstream(options.program) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(options.program, fs::perms::owner_all);
    deck = write("main.k", "*KEYWORD\n*END\n");
  }
  fs::path deck;
};

TEST_F(ImportScript, that_dies_is_told_in_a_sentence) {
  become("kill -9 $$");
  EXPECT_THAT(refusal(deck), AllOf(HasSubstr("main.k"), HasSubstr("was killed")));
  become("kill -SEGV $$");
  EXPECT_THAT(refusal(deck), HasSubstr("crashed (Segmentation fault)"));
  become("kill -BUS $$");
  EXPECT_THAT(refusal(deck), HasSubstr("crashed (Bus error)"));
  become("kill -XCPU $$");
  EXPECT_THAT(refusal(deck), HasSubstr("seconds of processor time"));
  become("exit 3");
  EXPECT_THAT(refusal(deck), HasSubstr("without an answer (status 3)"));
}

TEST_F(ImportScript, that_hangs_is_ended) {
  become("exec sleep 1000");
  options.patience = std::chrono::seconds(1);
  EXPECT_THAT(refusal(deck), HasSubstr("longer than the 1 seconds"));
  options.patience = std::chrono::seconds(600);
  options.progress = [](double) { return false; };
  EXPECT_EQ(refusal(deck), "cancelled");
}

TEST_F(ImportScript, that_talks_nonsense_is_told_in_a_sentence) {
  become("read request; echo nonsense >&0");
  EXPECT_THAT(refusal(deck), HasSubstr("it isn't JSON"));
  become("read request; echo '{\"answer\": \"imported\", \"to\": 1}' >&0");
  EXPECT_THAT(refusal(deck), HasSubstr("without what was asked for"));
  become("read request; echo '{\"answer\": \"imported\", \"to\": 1, \"descriptors\": 1}' >&0");
  EXPECT_THAT(refusal(deck), HasSubstr("more descriptors than came"));
  become("read request; echo '{\"answer\": \"failed\", \"to\": 1, \"message\": \"no\"}' >&0");
  EXPECT_EQ(refusal(deck), "no");
  options.program = root / "absent";
  EXPECT_THAT(refusal(deck), HasSubstr("could not be started"));
}

/// A program that has taken the place of prismesh-import and hands memory over. `make`: Python that makes the descriptor `memory`.
std::string hostile(const std::string& make) {
  return "exec python3 -c '\n"
         "import fcntl, os, socket\n"
         "memory = os.memfd_create(\"deck\", os.MFD_ALLOW_SEALING)\n" +
         make +
         "\ns = socket.socket(fileno=0)\n"
         "s.recv(65536)\n"
         "socket.send_fds(s, [b\"{\\\"answer\\\": \\\"imported\\\", \\\"to\\\": 1, \\\"descriptors\\\": 1}\\n\"], [memory])\n'";
}

TEST_F(ImportScript, that_hands_over_bad_memory_is_told_in_a_sentence) {
  const std::string seal = "\nfcntl.fcntl(memory, fcntl.F_ADD_SEALS, 15)";
  become(hostile("os.write(memory, b\"nonsense\" * 100)"));
  EXPECT_THAT(refusal(deck), HasSubstr("isn't sealed"));
  become(hostile("os.write(memory, b\"nonsense\" * 100)\nfcntl.fcntl(memory, fcntl.F_ADD_SEALS, 7)"));
  EXPECT_THAT(refusal(deck), HasSubstr("isn't sealed")) << "all but the seal against writing";
  become(hostile("os.write(memory, b\"nonsense\" * 100)" + seal));
  EXPECT_THAT(refusal(deck), HasSubstr("doesn't begin as one"));
  become(hostile("os.ftruncate(memory, 1 << 32)" + seal));
  EXPECT_THAT(refusal(deck), HasSubstr("never written"));
  become(hostile("os.ftruncate(memory, 1 << 50)" + seal));
  EXPECT_THAT(refusal(deck), HasSubstr("larger than"));
  become(hostile("pass" + seal));
  EXPECT_THAT(refusal(deck), HasSubstr("it is empty"));
  become(hostile("memory = os.open(\"/dev/null\", os.O_RDONLY)"));
  EXPECT_THAT(refusal(deck), HasSubstr("isn't sealed"));
}

TEST_F(ImportScript, that_answers_another_question_is_told_in_a_sentence) {
  const auto imported = import(write("whole.k", "*KEYWORD\n" + nodes_from(1, 4) + kShell + "*END\n"));
  ASSERT_TRUE(imported) << imported.error().text();
  const mesh::deck::OpenedDeck& opened = imported->opened;
  const std::string seal = "\nfcntl.fcntl(memory, fcntl.F_ADD_SEALS, 15)";
  become(hostile("os.write(memory, b\"nonsense\" * 100)" + seal));
  EXPECT_THAT(ipc::rewrite_deck(*opened.deck, opened.model, opened.model, options).error().text(), HasSubstr("without what was asked for"));
}

}  // namespace
}  // namespace prismesh::importer
