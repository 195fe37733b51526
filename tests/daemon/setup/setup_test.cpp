// The real prismesh-setup on a folder instead of the station's root: good, bad and hostile requests, and what is on the disk afterwards.
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/display/profile.h"
#include "drivers/settings/settings.h"
#include "ipc/setup/messages_json.h"
#include "tests/support/places.h"

namespace prismesh::test {
namespace {

using testing::HasSubstr;

constexpr const char* kSettings = "# of this laboratory\n[display]\nprofile = \"lenticular\"  # chosen by hand\n[remote]\n#listen = \"\"\n";

/// What a program said and how it ended.
struct Said {
  std::string answer;  ///< empty: none came
  int status = -1;
};

class SetupTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "setup_XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    root_ = pattern;
    write("etc/hostname", "prismesh-12ab\n");
    write("etc/hosts", "127.0.0.1 localhost\n127.0.1.1 prismesh-12ab\n::1 localhost\n");
    write("etc/prismesh/prismesh.toml", kSettings);
    write("etc/prismesh/set-up-due", "");
    write("usr/share/zoneinfo/zone1970.tab", "# comment\nDE,DK\t+5230+01322\tEurope/Berlin\tmost of Germany\nXX\t+0\tEurope/Nowhere\n");
    write("usr/share/zoneinfo/UTC", "zone");
    write("usr/share/zoneinfo/Europe/Berlin", "zone");
    std::filesystem::create_directories(root_ / "etc/systemd/network");
  }
  void TearDown() override {
    std::error_code ignored;
    std::filesystem::remove_all(root_, ignored);
  }
  void write(const std::string& path, const std::string& text) const {
    std::filesystem::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  std::string text(const std::string& path) const {
    std::stringstream text;
    text << std::ifstream(root_ / path).rdbuf();
    return text.str();
  }
  /// All files and links beneath the root, with what they hold.
  std::map<std::string, std::string> all() const {
    std::map<std::string, std::string> found;
    for (const auto& each : std::filesystem::recursive_directory_iterator(root_)) {
      const std::string name = std::filesystem::relative(each.path(), root_).string();
      if (each.is_symlink())
        found[name] = "-> " + std::filesystem::read_symlink(each.path()).string();
      else if (each.is_regular_file())
        found[name] = text(name);
    }
    return found;
  }

  /// Sends the bytes to a new process, as a program of the user `uid` (nothing: of this one's).
  Said send(const std::string& bytes, std::optional<uid_t> uid = {}) const {
    int ends[2];
    if (uid) {
      EXPECT_EQ(::seteuid(*uid), 0);
    }
    EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
    if (uid) {
      EXPECT_EQ(::seteuid(0), 0);
    }
    const std::string program = (programs_folder() / "prismesh-setup").string(), root = root_.string();
    const pid_t child = ::fork();
    if (child == 0) {
      ::dup2(ends[1], STDIN_FILENO);
      ::dup2(::open("/dev/null", O_WRONLY), STDERR_FILENO);
      ::dup2(STDERR_FILENO, STDOUT_FILENO);
      ::execl(program.c_str(), program.c_str(), "--root", root.c_str(), nullptr);
      ::_exit(127);
    }
    ::close(ends[1]);
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t some = ::send(ends[0], bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (some <= 0) break;  // it wants no more
      sent += static_cast<std::size_t>(some);
    }
    ::shutdown(ends[0], SHUT_WR);
    Said said;
    char buffer[4096];
    for (ssize_t some; (some = ::recv(ends[0], buffer, sizeof buffer, 0)) > 0;) said.answer.append(buffer, static_cast<std::size_t>(some));
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    said.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return said;
  }
  /// The answer to a request; a Failed one as "field: sentence", Done as "".
  std::string ask(const ipc::SetupRequest& request) const {
    const Said said = send(ipc::encode_setup_request(request).value() + "\n");
    const auto answer = ipc::decode_setup_answer(said.answer.substr(0, said.answer.find('\n')));
    if (!answer) return "no answer: " + said.answer;
    if (const auto* failed = std::get_if<ipc::Failed>(&*answer)) return failed->file + ": " + failed->message;
    return std::holds_alternative<ipc::Done>(*answer) ? "" : "a state";
  }
  ipc::StationSetup state() const {
    const Said said = send(ipc::encode_setup_request(ipc::GetSetup{}).value() + "\n");
    const auto answer = ipc::decode_setup_answer(said.answer.substr(0, said.answer.find('\n')));
    const auto* station = answer ? std::get_if<ipc::StationSetup>(&*answer) : nullptr;
    EXPECT_NE(station, nullptr) << said.answer;
    return station != nullptr ? *station : ipc::StationSetup();
  }

  std::filesystem::path root_;
};

TEST_F(SetupTest, tells_what_is_set) {
  const ipc::StationSetup station = state();
  EXPECT_TRUE(station.due);
  EXPECT_EQ(station.page, "");
  EXPECT_EQ(station.name, "prismesh-12ab");
  EXPECT_TRUE(station.network.dhcp);
  EXPECT_EQ(station.profile, "lenticular");
  EXPECT_FALSE(station.pairing);
  EXPECT_EQ(station.zone, "UTC");
  EXPECT_EQ(station.zones, (std::vector<std::string>{"Europe/Berlin", "UTC"})) << "none that has no data";
  EXPECT_FALSE(station.clock_is_kept);
  write("run/systemd/timesync/synchronized", "");
  EXPECT_TRUE(state().clock_is_kept);
}

TEST_F(SetupTest, sets_the_name_and_what_hosts_say_of_it) {
  EXPECT_EQ(ask(ipc::SetName{"crash-lab-3"}), "");
  EXPECT_EQ(text("etc/hostname"), "crash-lab-3\n");
  EXPECT_EQ(text("etc/hosts"), "127.0.0.1 localhost\n127.0.1.1 crash-lab-3\n::1 localhost\n");
  EXPECT_EQ(state().name, "crash-lab-3");
  std::filesystem::remove(root_ / "etc/hosts");
  EXPECT_EQ(ask(ipc::SetName{"again"}), "");
  EXPECT_THAT(text("etc/hosts"), HasSubstr("127.0.1.1 again\n"));
}

TEST_F(SetupTest, sets_a_fixed_address_and_goes_back_to_dhcp) {
  const char* const file = "etc/systemd/network/70-prismesh-setup.network";
  EXPECT_EQ(ask(ipc::SetNetwork{false, "192.168.1.20/24", "192.168.1.1", {"192.168.1.1", "9.9.9.9"}}), "");
  EXPECT_EQ(text(file),
            "# Written by the station's set-up.\n[Match]\nType=ether\n\n[Network]\nDHCP=no\nLinkLocalAddressing=ipv6\n"
            "Address=192.168.1.20/24\nGateway=192.168.1.1\nDNS=192.168.1.1\nDNS=9.9.9.9\n");
  EXPECT_THAT(text("etc/resolv.conf"), HasSubstr("\nnameserver 192.168.1.1\nnameserver 9.9.9.9\n"));
  const ipc::SetNetwork network = state().network;
  EXPECT_FALSE(network.dhcp);
  EXPECT_EQ(network.address, "192.168.1.20/24");
  EXPECT_EQ(network.dns.size(), 2U);
  EXPECT_EQ(ask(ipc::SetNetwork{}), "");
  EXPECT_FALSE(std::filesystem::exists(root_ / file));
  EXPECT_FALSE(std::filesystem::exists(root_ / "etc/resolv.conf"));
  EXPECT_TRUE(state().network.dhcp);
}

TEST_F(SetupTest, leaves_name_servers_alone_that_another_program_keeps) {
  write("etc/resolv.conf", "nameserver 10.0.0.1\n");
  EXPECT_EQ(ask(ipc::SetNetwork{false, "192.168.1.20/24", "", {"9.9.9.9"}}), "");
  EXPECT_EQ(text("etc/resolv.conf"), "nameserver 10.0.0.1\n");
  EXPECT_EQ(ask(ipc::SetNetwork{}), "");
  EXPECT_EQ(text("etc/resolv.conf"), "nameserver 10.0.0.1\n");
}

TEST_F(SetupTest, changes_only_their_lines_of_the_settings) {
  EXPECT_EQ(ask(ipc::SetProfile{"prism-mask"}), "");
  EXPECT_EQ(ask(ipc::SetPairing{true}), "");
  const std::string changed = text("etc/prismesh/prismesh.toml");
  EXPECT_THAT(changed, HasSubstr("# of this laboratory\n[display]\nprofile = \"prism-mask\"  # chosen by hand\n"));
  const auto settings = drivers::settings::parse_settings(changed, "prismesh.toml");
  ASSERT_TRUE(settings) << settings.error().text();
  EXPECT_EQ(settings->remote.address, "0.0.0.0");
  EXPECT_EQ(settings->remote.port, 7443);
  EXPECT_TRUE(state().pairing);
  EXPECT_EQ(ask(ipc::SetPairing{false}), "");
  EXPECT_FALSE(state().pairing);
  EXPECT_EQ(state().profile, "prism-mask");
}

TEST_F(SetupTest, takes_a_calibrated_profile_over_for_all_programs) {
  drivers::display::Profile profile = drivers::display::built_in_profiles().front();
  profile.name = "EIZ-CG2420";
  profile.monitor = {"EIZ \"CG2420\"", "12", {1920, 1200}};
  profile.optics.zero_mm = 0.125;
  EXPECT_EQ(ask(ipc::SetCalibration{"# of nobody's business\n" + drivers::display::profile_text(profile)}), "");
  EXPECT_EQ(text("etc/prismesh/displays/EIZ-CG2420.toml").find("business"), std::string::npos) << "written from what was read";
  const auto settings = drivers::settings::parse_settings(text("etc/prismesh/prismesh.toml"), root_ / "etc/prismesh/prismesh.toml");
  ASSERT_TRUE(settings) << settings.error().text();
  const auto found = drivers::display::find_profile(settings->display.profile);
  ASSERT_TRUE(found) << found.error().text();
  EXPECT_EQ(*found, profile);
  profile.name = "../../evil";
  const auto before = all();
  EXPECT_THAT(ask(ipc::SetCalibration{drivers::display::profile_text(profile)}), HasSubstr("letters, digits and hyphens"));
  EXPECT_EQ(all(), before);
}

TEST_F(SetupTest, keeps_another_address_that_somebody_has_set_for_pairing) {
  write("etc/prismesh/prismesh.toml", "[remote]\nlisten = \"192.168.1.20:9000\"\n");
  EXPECT_EQ(ask(ipc::SetPairing{true}), "");
  EXPECT_EQ(text("etc/prismesh/prismesh.toml"), "[remote]\nlisten = \"192.168.1.20:9000\"\n");
}

TEST_F(SetupTest, settings_that_cannot_be_read_are_told_and_stay) {
  const std::string broken = "[display]\nprofil = \"mono\"\n";
  write("etc/prismesh/prismesh.toml", broken);
  EXPECT_THAT(ask(ipc::SetProfile{"mono"}), HasSubstr("profil"));
  EXPECT_THAT(ask(ipc::SetPairing{true}), HasSubstr("profil"));
  EXPECT_EQ(text("etc/prismesh/prismesh.toml"), broken);
}

TEST_F(SetupTest, tells_a_zone_that_the_list_has_not) {
  std::filesystem::create_symlink("/usr/share/zoneinfo/Etc/UTC", root_ / "etc/localtime");  // as Debian has it
  EXPECT_EQ(state().zone, "UTC");
  EXPECT_EQ(state().zones, (std::vector<std::string>{"Europe/Berlin", "UTC"}));
  std::filesystem::remove(root_ / "etc/localtime");
  std::filesystem::create_symlink("../usr/share/zoneinfo/Europe/Oslo", root_ / "etc/localtime");
  EXPECT_EQ(state().zone, "Europe/Oslo");
  EXPECT_EQ(state().zones, (std::vector<std::string>{"Europe/Berlin", "Europe/Oslo", "UTC"})) << "it can stay as it is";
}

TEST_F(SetupTest, new_network_settings_end_a_fallback) {
  write("run/systemd/network/00-prismesh.network", "[Match]\nType=ether\n");
  ipc::SetNetwork network;
  network.dhcp = false;
  network.address = "10.0.0.2/24";
  EXPECT_EQ(ask(network), "");
  EXPECT_FALSE(std::filesystem::exists(root_ / "run/systemd/network/00-prismesh.network")) << "it would hide them";
}

TEST_F(SetupTest, sets_the_zone_by_a_link) {
  EXPECT_EQ(ask(ipc::SetZone{"Europe/Berlin"}), "");
  EXPECT_EQ(std::filesystem::read_symlink(root_ / "etc/localtime"), "../usr/share/zoneinfo/Europe/Berlin");
  EXPECT_EQ(state().zone, "Europe/Berlin");
  EXPECT_THAT(ask(ipc::SetZone{"Europe/Atlantis"}), HasSubstr("no such zone"));
  EXPECT_THAT(ask(ipc::SetZone{"Europe"}), HasSubstr("no such zone")) << "a folder";
  EXPECT_EQ(state().zone, "Europe/Berlin");
}

TEST_F(SetupTest, keeps_the_page_until_it_is_finished) {
  EXPECT_EQ(ask(ipc::KeepPage{"zone"}), "");
  EXPECT_EQ(state().page, "zone");
  EXPECT_EQ(ask(ipc::FinishSetup{}), "");
  EXPECT_FALSE(state().due);
  EXPECT_EQ(ask(ipc::KeepPage{"name"}), "");
  EXPECT_FALSE(state().due) << "called again later it doesn't come by itself";
  EXPECT_EQ(ask(ipc::FinishSetup{}), "") << "once more";
}

TEST_F(SetupTest, refuses_hostile_requests_and_writes_nothing) {
  const auto before = all();
  const std::string name = R"({"request":"set_name","name":")", end = "\"}\n";
  const std::string hostile[] = {
      name + "a\\nb" + end,
      name + "../../etc/passwd" + end,
      name + "a\\u0000b" + end,
      name + "\xff\xfe" + end,
      R"({"request":"set_zone","zone":"../../../etc/passwd"})"
      "\n",
      R"({"request":"set_profile","profile":"/root/mine.toml"})"
      "\n",
      R"({"request":"set_network","dhcp":false,"address":"10.0.0.2/24","gateway":"10.0.0.1\n[Match]\nName=*"})"
      "\n",
      R"({"request":"set_network","dhcp":false,"address":"10.0.0.2/24","dns":["9.9.9.9\nDNSSEC=no"]})"
      "\n",
      R"({"request":"keep_page","page":"a\nb"})"
      "\n",
      R"({"request":"set_clock","date":"2026-11-31","time":"10:00"})"
      "\n",
      R"({"request":"run","command":"/bin/sh"})"
      "\n",
      R"({"request":"set_name","name":"a","root":"/"})"
      "\n",
      "GET / HTTP/1.1\r\n\r\n",
      "\n",
      "",
      R"({"request":"set_name","name":"cut)",
      std::string(200'000, '[') + "\n",
      name + std::string(10'000'000, 'a') + end,
      std::string(10'000'000, '\0'),
  };
  for (const std::string& each : hostile) {
    const Said said = send(each);
    EXPECT_EQ(said.status, 1) << each.substr(0, 80);
    if (!said.answer.empty()) {
      const auto answer = ipc::decode_setup_answer(said.answer.substr(0, said.answer.find('\n')));
      ASSERT_TRUE(answer) << each.substr(0, 80) << "\n" << said.answer;
      EXPECT_TRUE(std::holds_alternative<ipc::Failed>(*answer)) << said.answer;
    }
    EXPECT_EQ(all(), before) << each.substr(0, 80);
  }
}

TEST_F(SetupTest, carries_out_one_request_of_a_connection) {
  const std::string first = ipc::encode_setup_request(ipc::SetName{"first"}).value(),
                    second = ipc::encode_setup_request(ipc::SetName{"second"}).value();
  EXPECT_EQ(send(first + "\n" + second + "\n").status, 0);
  EXPECT_EQ(text("etc/hostname"), "first\n");
}

TEST_F(SetupTest, refuses_another_user) {
  if (::geteuid() != 0) GTEST_SKIP() << "SKIPPED: only root can ask as another user";
  const auto before = all();
  const Said said = send(ipc::encode_setup_request(ipc::SetName{"mine"}).value() + "\n", uid_t{65534});
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.answer, HasSubstr("may not set this station up"));
  EXPECT_EQ(all(), before);
}

TEST_F(SetupTest, a_disk_that_takes_nothing_leaves_what_was) {
  if (::geteuid() == 0) {
    // Root may write everywhere: a folder stands where the new file has to go.
    std::filesystem::remove(root_ / "etc/hostname");
    std::filesystem::create_directories(root_ / "etc/hostname/in_the_way");
  } else {
    std::filesystem::permissions(root_ / "etc", std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  }
  const auto before = all();
  EXPECT_THAT(ask(ipc::SetName{"lost"}), HasSubstr("hostname"));
  EXPECT_EQ(all(), before) << "neither a part of it nor a file beside it";
  std::filesystem::permissions(root_ / "etc", std::filesystem::perms::owner_all);
}

TEST_F(SetupTest, a_planted_link_beside_the_zone_is_not_followed) {
  write("kept", "mine");
  std::filesystem::create_symlink(root_ / "kept", root_ / "etc/.localtime.new");
  EXPECT_EQ(ask(ipc::SetZone{"UTC"}), "");
  EXPECT_EQ(text("kept"), "mine");
  EXPECT_EQ(state().zone, "UTC");
}

}  // namespace
}  // namespace prismesh::test
