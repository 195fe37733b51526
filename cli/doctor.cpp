// Says of everything that a station needs whether it is good, or what to do about it.
#include <algorithm>
#include <ostream>

#include "cli/commands.h"
#include "cli/json_output.h"
#include "cli/machine_checks.h"
#include "cli/report_text.h"
#include "ipc/device/client.h"
#include "ipc/model/client.h"
#include "ipc/wire/roles.h"
#include "ipc/wire/runtime_directory.h"

namespace prismesh::cli {

namespace {

constexpr std::chrono::milliseconds kPatience{3000};

template <class Client>
Finding daemon_finding(const std::string& what, const std::filesystem::path& socket) {
  Result<Client> client = Client::begin(socket, "prismesh doctor");
  if (!client) return {what, Grade::note, client.error().text(), {}};
  const Result<bool> greeted = client->greeted(kPatience);
  if (!greeted) return {what, Grade::bad, greeted.error().text(), {}};
  if (!*greeted) return {what, Grade::bad, "it listens, but doesn't answer", "systemctl restart it, or end it and start it again"};
  return {what, Grade::good, "version " + client->welcome().version + " answers in " + socket.parent_path().string(), {}};
}

Finding roles_finding() {
  const Result<ipc::RoleTable> roles = ipc::read_roles();
  if (!roles) return {"roles", Grade::bad, roles.error().text(), "docs/roles.md"};
  return {"roles", Grade::good, roles->has_others() ? "other users have roles" : "only this user and root may use the daemons", {}};
}

std::vector<Finding> all_findings(const DoctorOptions& options) {
  const Machine machine = this_machine(ipc::state_directory(options.state_directory));
  std::vector<Finding> all;
  const auto add = [&](std::vector<Finding> more) { std::move(more.begin(), more.end(), std::back_inserter(all)); };
  add(check_displays(machine));
  add(check_graphics(machine));
  add(check_seat(machine));
  const Result<drivers::settings::StationSettings> settings = drivers::settings::read_settings(std::nullopt);
  if (settings)
    add(check_ports(machine, *settings));
  else
    add({{"settings", Grade::bad, settings.error().text(), "docs/settings.md"}});
  add(check_realtime(machine));
  add(check_disk(machine));
  add(check_clock(machine));
  add(check_units(machine));
  add({roles_finding()});
  add({daemon_finding<ipc::Client>("modeld", ipc::model_socket_path(options.runtime_directory))});
  add({daemon_finding<ipc::DeviceClient>("deviced", ipc::device_socket_path(options.runtime_directory))});
  return all;
}

void print(std::ostream& out, const std::vector<Finding>& findings) {
  std::size_t width = 0;
  for (const Finding& finding : findings) width = std::max(width, finding.what.size());
  for (const Finding& finding : findings) {
    const char* grade = finding.grade == Grade::good ? "good" : finding.grade == Grade::note ? "note" : "BAD ";
    out << grade << "  " << finding.what << std::string(width - finding.what.size() + 2, ' ') << printable(finding.says) << '\n';
    if (!finding.to_do.empty()) out << std::string(width + 8, ' ') << "-> " << finding.to_do << '\n';
  }
}

}  // namespace

int doctor(const DoctorOptions& options, const Common& common, const Context& context) {
  const std::vector<Finding> findings = all_findings(options);
  if (common.json)
    context.out << findings_json(findings) << '\n';
  else
    print(context.out, findings);
  const bool is_bad = std::any_of(findings.begin(), findings.end(), [](const Finding& each) { return each.grade == Grade::bad; });
  return is_bad ? kFailed : kDone;
}

}  // namespace prismesh::cli
