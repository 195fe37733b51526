// The program prismesh-intake with its settings and its socket on this machine.
#include <stdlib.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "daemon/intake/daemon.h"
#include "ipc/intake/client.h"
#include "ipc/intake/pairing_code.h"
#include "tests/daemon/intake/tls_client.h"
#include "tests/station/process.h"
#include "tests/support/places.h"

namespace prismesh::intake {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class IntakeProgram : public ::testing::Test {
 protected:
  IntakeProgram() {
    std::string name = (fs::temp_directory_path() / "prismesh_intake_XXXXXX").string();
    root_ = ::mkdtemp(name.data());
  }
  ~IntakeProgram() override { fs::remove_all(root_); }

  std::vector<std::string> command(const std::string& settings) const {
    std::ofstream(root_ / "prismesh.toml") << settings;
    return {(test::programs_folder() / "prismesh-intake").string(),
            "--runtime-dir",
            (root_ / "run").string(),
            "--state-dir",
            (root_ / "state").string(),
            "--config",
            (root_ / "prismesh.toml").string()};
  }
  fs::path root_;
};

TEST_F(IntakeProgram, serves_nobody_unless_the_settings_say_so) {
  test::Process program(command(""), {});
  EXPECT_EQ(program.wait_for_exit(), 1);
  EXPECT_THAT(program.standard_error(), HasSubstr("set remote.listen"));
  EXPECT_FALSE(fs::exists(root_ / "state"));
}

TEST_F(IntakeProgram, takes_its_limits_from_the_settings) {
  drivers::settings::RemoteSettings settings;
  EXPECT_FALSE(intake_options(settings, root_));
  settings.address = "10.0.0.1";
  settings.port = 7443;
  settings.quota_gb = 3;
  settings.file_gb = 2;
  settings.reserved_gb = 1;
  settings.upload_hours = 5;
  settings.hosts = {"station"};
  const Result<IntakeOptions> options = intake_options(settings, root_);
  ASSERT_TRUE(options);
  EXPECT_EQ(options->server.address, "10.0.0.1");
  EXPECT_EQ(options->server.port, 7443);
  EXPECT_EQ(options->store_limits.quota_bytes, std::uint64_t{3} << 30);
  EXPECT_EQ(options->store_limits.file_bytes, std::uint64_t{2} << 30);
  EXPECT_EQ(options->store_limits.reserved_bytes, std::uint64_t{1} << 30);
  EXPECT_EQ(options->store_limits.upload_lifetime_s, 18'000);
  EXPECT_EQ(options->hosts, settings.hosts);
}

TEST_F(IntakeProgram, makes_codes_for_this_machine_s_programs_and_tells_them_of_tokens) {
  IntakeOptions options;
  options.state_directory = root_ / "state";
  options.store = root_ / "state/store";
  options.store_limits.reserved_bytes = 0;
  Result<Daemon> daemon = Daemon::start({root_ / "run", options});
  ASSERT_TRUE(daemon) << daemon.error().text();
  std::thread serving([&] { daemon->run(); });
  {
    Result<ipc::IntakeClient> client = ipc::IntakeClient::connect(ipc::intake_socket_path(root_ / "run"), "test");
    ASSERT_TRUE(client) << client.error().text();
    const auto info = client->call(ipc::GetIntake{});
    ASSERT_TRUE(info);
    EXPECT_EQ(std::get<ipc::IntakeInfo>(*info).fingerprint, daemon->intake().fingerprint().hex());
    EXPECT_EQ(std::get<ipc::IntakeInfo>(*info).address, "127.0.0.1:" + std::to_string(daemon->intake().port()));
    EXPECT_FALSE(client->call(ipc::MakePairingCode{"", {"everything"}}));
    EXPECT_FALSE(client->call(ipc::MakePairingCode{"", {}}));
    const auto made = client->call(ipc::MakePairingCode{"ann", {"read"}});
    ASSERT_TRUE(made) << made.error().text();
    const auto code = ipc::decode_pairing_code(std::get<ipc::MadePairingCode>(*made).code);
    ASSERT_TRUE(code);
    TlsClient remote(daemon->intake().port());
    EXPECT_TRUE(std::equal(code->fingerprint.begin(), code->fingerprint.end(), remote.fingerprint().bytes.begin()));
    const std::string body = "{\"secret\": \"" + ipc::encode_pairing_secret(code->secret) + "\"}";
    ASSERT_TRUE(remote.send("POST /pair HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: " +
                            std::to_string(body.size()) + "\r\n\r\n" + body));
    EXPECT_EQ(remote.receive().status, 200u);
    const auto tokens = client->call(ipc::GetTokens{});
    ASSERT_EQ(std::get<ipc::Tokens>(*tokens).tokens.size(), 1u);
    EXPECT_EQ(std::get<ipc::Tokens>(*tokens).tokens[0].scopes, std::vector<std::string>{"read"});
    EXPECT_TRUE(client->call(ipc::RevokeToken{"ann"}));
    EXPECT_FALSE(client->call(ipc::RevokeToken{"ann"}));
  }
  daemon->stop();
  serving.join();
}

}  // namespace
}  // namespace prismesh::intake
