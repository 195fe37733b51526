// `info --sandboxed`: the same as without, and in a sentence what it can't do.
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <string>

#include <unistd.h>

#include "ipc/import/client.h"
#include "tests/cli/cli_fixture.h"
#include "tests/support/places.h"
#include "tests/support/real_deck.h"

namespace prismesh::cli {
namespace {

class SandboxedInfo : public Cli {};

TEST_F(SandboxedInfo, prints_the_same_as_without) {
  const std::string deck = write("main.k", plate_text());
  const Outcome plain = prismesh({"info", deck});
  const Outcome sandboxed = prismesh({"info", deck, "--sandboxed"});
  EXPECT_EQ(sandboxed.status, kDone) << sandboxed.err;
  EXPECT_EQ(sandboxed.out, plain.out);
  EXPECT_EQ(sandboxed.err, plain.err);
}

TEST_F(SandboxedInfo, reads_no_settings_beside_the_deck) {
  const std::string deck = write("main.k", plate_text());
  write("main.k.prismesh.toml", "this is no settings file");
  EXPECT_EQ(prismesh({"info", deck}).status, kFailed);
  EXPECT_EQ(prismesh({"info", deck, "--sandboxed"}).status, kDone);
  EXPECT_EQ(prismesh({"info", deck, "--sandboxed", "--save-settings"}).status, kWrongUsage);
}

TEST_F(SandboxedInfo, says_why_a_deck_isnt_opened) {
  const Outcome none = prismesh({"info", path("none.k"), "--sandboxed"});
  EXPECT_EQ(none.status, kFailed);
  EXPECT_THAT(none.err, ::testing::AllOf(StartsWith(path("none.k")), HasSubstr("No such file")));
  EXPECT_EQ(none.out, "");
  const Outcome bad =
      prismesh({"info", write("bad.k", "*KEYWORD\n*NODE\n       1     nothing\n*ELEMENT_MASS\n 1 1\n"), "--sandboxed", "--json"});
  const Outcome plain = prismesh({"info", path("bad.k"), "--json"});
  EXPECT_EQ(bad.status, plain.status);
  EXPECT_EQ(bad.err, plain.err);
}

/// The processes that this one has started.
std::vector<pid_t> children() {
  std::vector<pid_t> all;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream in(entry.path() / "stat");
    std::string text;
    std::getline(in, text);
    const std::size_t name_end = text.rfind(')');
    if (name_end == std::string::npos) continue;
    std::istringstream rest(text.substr(name_end + 1));
    std::string state;
    pid_t parent = 0;
    if (rest >> state >> parent && parent == ::getpid()) all.push_back(std::stoi(entry.path().filename().string()));
  }
  return all;
}

TEST_F(SandboxedInfo, tells_of_a_kill_in_the_middle_in_a_sentence) {
  ASSERT_EQ(prismesh({"sample", "--elements", "200000", "-o", path("large.k")}).status, kDone);
  ipc::ImportOptions options;
  options.program = test::programs_folder() / "prismesh-import";
  options.progress = [](double) {
    for (const pid_t child : children()) ::kill(child, SIGKILL);
    return true;
  };
  const auto imported = ipc::import_deck(path("large.k"), options);
  ASSERT_FALSE(imported);
  EXPECT_EQ(imported.error().file, path("large.k"));
  EXPECT_THAT(imported.error().message, ::testing::AllOf(HasSubstr("was killed"), HasSubstr("it isn't opened")));
  EXPECT_TRUE(children().empty()) << "no process is left";
}

/// With one spelling for each file: without the sandbox a name keeps the dots of the deck's own.
nlohmann::json with_plain_files(nlohmann::json info) {
  for (nlohmann::json& file : info["files"]) file = std::filesystem::path(file.get<std::string>()).lexically_normal().string();
  return info;
}

TEST_F(SandboxedInfo, of_real_decks_has_all_that_it_has_without) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS names no folder with counts.json: REAL DECKS ARE NOT TESTED";
  const nlohmann::json counts = nlohmann::json::parse(read(*decks / "counts.json"));
  std::size_t same = 0;
  for (const auto& [name, expected] : counts.items()) {
    const std::string deck = (*decks / expected["main"].get<std::string>()).string();
    const Outcome plain = prismesh({"info", deck, "--json"});
    const Outcome sandboxed = prismesh({"info", deck, "--json", "--sandboxed"});
    EXPECT_EQ(sandboxed.status, plain.status) << name;
    EXPECT_EQ(sandboxed.err, plain.err) << name;
    if (plain.status != kDone) continue;
    EXPECT_EQ(with_plain_files(sandboxed.json()), with_plain_files(plain.json())) << name;
    ++same;
  }
  EXPECT_GT(same, 40u);
}

}  // namespace
}  // namespace prismesh::cli
