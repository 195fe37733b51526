// The commands about stations against a running prismesh-intake: pair, push, pull, stations, watch, intake.
#include <stdlib.h>

#include <csignal>

#include "tests/cli/cli_fixture.h"
#include "tests/ipc/remote/cutting_line.h"
#include "tests/station/process.h"
#include "tests/support/places.h"
#include "tests/support/real_deck.h"

namespace prismesh::cli {
namespace {

namespace fs = std::filesystem;

class RemoteCommands : public Cli {
 protected:
  void SetUp() override {
    Cli::SetUp();
    ::setenv("XDG_CONFIG_HOME", path("config").c_str(), 1);
    write("station.toml", "[remote]\nlisten = \"127.0.0.1:0\"\nreserved_gb = 0\n");
    station_ = std::make_unique<test::Process>(
        std::vector<std::string>{(test::programs_folder() / "prismesh-intake").string(), "--runtime-dir", path("run"), "--state-dir",
                                 path("state"), "--config", path("station.toml")},
        std::map<std::string, std::string>());
    for (int tries = 0; tries < 500 && prismesh({"intake", "tokens", "--runtime-dir", path("run")}).status != kDone; ++tries)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  void TearDown() override {
    station_.reset();
    ::unsetenv("XDG_CONFIG_HOME");
    Cli::TearDown();
  }

  nlohmann::json make_code() const {
    const Outcome made = prismesh({"intake", "code", "--runtime-dir", path("run"), "--json"});
    EXPECT_EQ(made.status, kDone) << made.err;
    return made.json();
  }
  /// Returns the station's address.
  std::string pair_as(const std::string& name) const {
    const nlohmann::json made = make_code();
    const std::string address = made.at("address");
    const Outcome paired = prismesh({"pair", address, made.at("code"), "--name", name, "--json"});
    EXPECT_EQ(paired.status, kDone) << paired.err;
    EXPECT_EQ(paired.json().at("fingerprint"), made.at("fingerprint"));
    return address;
  }
  std::map<std::string, std::string> files_in(const std::string& name) const {
    std::map<std::string, std::string> texts;
    for (const auto& entry : fs::recursive_directory_iterator(folder / name))
      if (entry.is_regular_file()) texts[fs::relative(entry.path(), folder / name).string()] = read(entry.path());
    return texts;
  }

  std::unique_ptr<test::Process> station_;
  std::unique_ptr<ipc::remote::CuttingLine> remote_line_;
};

TEST_F(RemoteCommands, a_deck_with_includes_comes_back_with_the_same_bytes) {
  write("deck/car/main.k", "*KEYWORD\n*INCLUDE\nparts/plate.k\n*INCLUDE\n../shared/nothing.k\n*END\n");
  write("deck/car/parts/plate.k", plate_text());
  write("deck/shared/nothing.k", "*KEYWORD\n*END\n");
  const std::string address = pair_as("ann");
  const Outcome pushed = prismesh({"push", path("deck/car/main.k"), "--name", "my car", "--json"});
  ASSERT_EQ(pushed.status, kDone) << pushed.err;
  EXPECT_THAT(pushed.err, HasSubstr("outside its folder"));
  EXPECT_EQ(pushed.json().at("files"), 3);
  EXPECT_EQ(pushed.json().at("was_there"), false);
  const Outcome listed = prismesh({"stations", "models", "--json"});
  EXPECT_EQ(listed.json().at("models").at(0).at("model"), pushed.json().at("model"));
  EXPECT_EQ(listed.json().at("models").at(0).at("name"), "my car");
  const Outcome pulled = prismesh({"pull", "my car", "--station", address, "-o", path("back"), "--json"});
  ASSERT_EQ(pulled.status, kDone) << pulled.err;
  EXPECT_EQ(pulled.json().at("main"), path("back/car/main.k"));
  EXPECT_EQ(files_in("back"), files_in("deck"));
  EXPECT_EQ(prismesh({"diff", path("deck/car/main.k"), path("back/car/main.k"), "--json"}).json().at("lines_changed"), 0);
  EXPECT_THAT(prismesh({"push", path("deck/car/main.k")}).out, HasSubstr("has it already"));
}

TEST_F(RemoteCommands, tokens_are_the_users_own_and_end_when_they_are_revoked) {
  const std::string address = pair_as("ann");
  const std::string file = path("config/prismesh/stations/stations.json");
  EXPECT_EQ(fs::status(file).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(fs::status(path("config/prismesh/stations")).permissions(), fs::perms::owner_all);
  const std::string token = nlohmann::json::parse(read(file)).at("stations").at(0).at("token");
  for (const Outcome& said :
       {prismesh({"stations", "--json"}), prismesh({"stations"}), prismesh({"intake", "tokens", "--runtime-dir", path("run")})}) {
    EXPECT_THAT(said.out, AllOf(HasSubstr("ann"), ::testing::Not(HasSubstr(token))));
  }
  EXPECT_EQ(prismesh({"intake", "revoke", "ann", "--runtime-dir", path("run")}).status, kDone);
  const Outcome refused = prismesh({"push", write("plate.k", plate_text())});
  EXPECT_EQ(refused.status, kFailed);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("revoked"), HasSubstr("prismesh pair " + address + " CODE")));
  EXPECT_EQ(prismesh({"stations", "forget", address}).status, kDone);
  EXPECT_THAT(prismesh({"stations", "models"}).err, HasSubstr("paired with no station"));
}

TEST_F(RemoteCommands, forgetting_a_station_makes_the_token_void_there) {
  const std::string address = pair_as("ann");
  EXPECT_THAT(prismesh({"intake", "tokens", "--runtime-dir", path("run"), "--json"}).json().at("tokens"), ::testing::SizeIs(1));
  const Outcome forgotten = prismesh({"stations", "forget", address, "--json"});
  EXPECT_EQ(forgotten.err, "");
  EXPECT_EQ(forgotten.json(), (nlohmann::json{{"station", address}, {"token_is_void", true}}));
  EXPECT_THAT(prismesh({"intake", "tokens", "--runtime-dir", path("run"), "--json"}).json().at("tokens"), ::testing::IsEmpty());
}

TEST_F(RemoteCommands, refusals_are_sentences) {
  const nlohmann::json made = make_code();
  const std::string address = made.at("address"), code = made.at("code");
  std::string other = code;
  other[0] = other[0] == '0' ? '1' : '0';
  EXPECT_THAT(prismesh({"pair", address, other}).err, HasSubstr("isn't the station that made this code"));
  other = code;
  other.back() = other.back() == '0' ? '1' : '0';
  EXPECT_THAT(prismesh({"pair", address, other}).err, HasSubstr("make a new one at the station"));
  EXPECT_THAT(prismesh({"pair", "a b", code}).err, HasSubstr("is no station"));
  EXPECT_THAT(prismesh({"pair", "127.0.0.1:1", code}).err, HasSubstr("can't be reached"));
  EXPECT_THAT(prismesh({"push", write("plate.k", plate_text())}).err, HasSubstr("prismesh pair STATION CODE"));
  EXPECT_EQ(prismesh({"pair", address, code, "--name", "ann"}).status, kDone) << "the code wasn't spent";
  EXPECT_THAT(prismesh({"pull", "nothing"}).err, HasSubstr("has no model 'nothing'"));
  EXPECT_THAT(prismesh({"push", path("none.k")}).err, HasSubstr("none.k"));
  EXPECT_EQ(prismesh({"stations", "models"}).out, address + " has no models\n");
}

TEST_F(RemoteCommands, watching_prints_what_is_published) {
  pair_as("ann");
  test::Process watching({(test::programs_folder() / "prismesh").string(), "watch"}, {{"XDG_CONFIG_HOME", path("config")}});
  ASSERT_NE(watching.wait_for("follows "), "");
  const Outcome pushed = prismesh({"push", write("plate.k", plate_text()), "--json"});
  ASSERT_EQ(pushed.status, kDone) << pushed.err;
  EXPECT_THAT(watching.wait_for("published "), HasSubstr(pushed.json().at("model").get<std::string>() + "  plate.k"));
  watching.kill(SIGINT);
  EXPECT_EQ(watching.wait_for_exit(), kDone);
}

TEST_F(RemoteCommands, a_push_that_is_killed_goes_on_when_it_is_called_again) {
  const std::string deck = path("sample.k");
  ASSERT_EQ(prismesh({"sample", "--elements", "70000", "-o", deck}).status, kDone);
  const nlohmann::json made = make_code();
  const std::string address = made.at("address");
  std::uint64_t cut = 6'000'000;
  remote_line_ = std::make_unique<ipc::remote::CuttingLine>(static_cast<std::uint16_t>(std::stoi(address.substr(address.find(':') + 1))),
                                                            [&] { return cut; });
  const std::string through = "127.0.0.1:" + std::to_string(remote_line_->port());
  ASSERT_EQ(prismesh({"pair", through, made.at("code"), "--name", "ann"}).status, kDone);
  ASSERT_GT(fs::file_size(deck), 8'000'000u);
  test::Process pushing({(test::programs_folder() / "prismesh").string(), "push", deck, "--json"}, {{"XDG_CONFIG_HOME", path("config")}});
  // Killed in the middle of the second chunk, before it is sent anew.
  while (remote_line_->cuts() == 0 && pushing.running()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  pushing.kill(SIGKILL);
  pushing.wait_for_exit();
  cut = ipc::remote::kNeverCut;
  const Outcome pushed = prismesh({"push", deck, "--json"});
  ASSERT_EQ(pushed.status, kDone) << pushed.err;
  EXPECT_LE(pushed.json().at("sent_bytes").get<std::uint64_t>(), fs::file_size(deck) - 4'194'304);
  ASSERT_EQ(prismesh({"pull", "sample.k", "-o", path("back")}).status, kDone);
  EXPECT_EQ(read(path("back/sample.k")), read(deck));
}

TEST_F(RemoteCommands, describing_reads_stored_models_in_the_sandbox) {
  pair_as("ann");
  const Outcome pushed = prismesh({"push", write("plate.k", plate_text()), "--json"});
  ASSERT_EQ(pushed.status, kDone) << pushed.err;
  const std::string model = pushed.json().at("model");
  ASSERT_EQ(prismesh({"push", write("none.k", "this is no deck\n")}).status, kFailed) << "the command reads it before it sends it";
  const nlohmann::json info = prismesh({"info", path("plate.k"), "--json"}).json();
  const Outcome described = prismesh({"intake", "describe", "--runtime-dir", path("run"), "--json"});
  ASSERT_EQ(described.status, kDone) << described.err;
  EXPECT_EQ(described.json().at("model"), model);
  EXPECT_EQ(described.json().at("nodes"), info.at("nodes"));
  EXPECT_EQ(described.json().at("parts"), info.at("parts").size());
  const nlohmann::json listed = prismesh({"stations", "models", "--json"}).json().at("models").at(0);
  EXPECT_EQ(listed.at("figures").at("elements"), described.json().at("elements"));
  if (described.json().at("picture") == true) {
    EXPECT_THAT(prismesh({"intake", "describe", "--runtime-dir", path("run")}).out, HasSubstr("all models are described"));
  }
  EXPECT_EQ(prismesh({"intake", "describe", "plate.k", "--runtime-dir", path("run")}).status, kDone) << "again, because it is asked for";
  EXPECT_THAT(prismesh({"intake", "describe", "nothing", "--runtime-dir", path("run")}).err, HasSubstr("there is no such model"));
}

TEST_F(RemoteCommands, RealDecks) {
  const auto decks = test::real_decks();
  if (!decks) GTEST_SKIP() << "PRISMESH_MODELS doesn't name the real decks";
  std::ifstream in(*decks / "counts.json");
  const auto counts = nlohmann::json::parse(in);
  pair_as("ann");
  int several = 0, tried = 0;
  for (const auto& [name, facts] : counts.items()) {
    const fs::path main = *decks / facts.at("main").get<std::string>();
    // Small ones: the whole way is the same for all.
    if (fs::file_size(main) > 300'000) continue;
    const Outcome info = prismesh({"info", main.string(), "--json"});
    if (info.status != kDone) continue;
    ++tried;
    const Outcome pushed = prismesh({"push", main.string(), "--json"});
    ASSERT_EQ(pushed.status, kDone) << name << ": " << pushed.err;
    several += pushed.json().at("files") > 1;
    const Outcome pulled = prismesh({"pull", pushed.json().at("model"), "-o", path("back"), "--json"});
    ASSERT_EQ(pulled.status, kDone) << name << ": " << pulled.err;
    const fs::path back = pulled.json().at("main").get<std::string>();
    EXPECT_EQ(read(back), read(main)) << name;
    const nlohmann::json again = prismesh({"info", back.string(), "--json"}).json(), before = info.json();
    for (const char* field : {"nodes", "elements", "parts"}) EXPECT_EQ(again.at(field), before.at(field)) << name;
    EXPECT_EQ(again.at("files").size(), before.at("files").size()) << name;
    fs::remove_all(path("back"));
  }
  EXPECT_GT(tried, 10);
  EXPECT_GT(several, 0);
}

}  // namespace
}  // namespace prismesh::cli
