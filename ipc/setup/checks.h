// Whether what somebody typed to set a station up can be meant. The kiosk asks before it sends, and prismesh-setup before it writes.
#pragma once

#include <string>
#include <string_view>

#include "base/error.h"
#include "ipc/setup/messages.h"

namespace prismesh::ipc {

// Errors: a sentence, and in Error::file the field: "name", "address", "gateway", "dns", "profile", "calibration", "zone", "date", "time",
// "page".

/// A host name by RFC 1123 that is a single label: 1 to 63 letters, digits and hyphens, none of these at an end, and not digits alone.
Result<void> check_name(std::string_view name);
/// A fixed address needs a prefix, the gateway must lie in its network (that of IPv6 may be link-local), and there are three name servers
/// at most. Addresses that no single machine can have are refused.
Result<void> check_network(const SetNetwork& network);
Result<void> check_profile(std::string_view profile);
/// The text of a whole profile file, with a name of letters, digits and hyphens that isn't a built-in one.
Result<void> check_calibration(const std::string& profile);
/// Whether it is written as a zone is; whether there is one, only the machine knows.
Result<void> check_zone(std::string_view zone);
/// Days that there are, from 2020 to 2099.
Result<void> check_clock(const SetClock& clock);

/// All of a request.
Result<void> check_setup(const SetupRequest& request);

}  // namespace prismesh::ipc
