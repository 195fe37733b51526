// What every request is checked for before anything is done with it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/intake/http/request.h"

namespace prismesh::intake {

/// Refuses a request that isn't what it seems: a header twice that must come once, a body without a length, another station's or a
/// stranger's Host (a name that was bound anew to this address), a page of another Origin, a method that a header exchanges.
/// `hosts`: names that this station has, in small letters; its addresses are always taken.
std::optional<HttpResponse> check_request(const HttpRequest& request, const std::vector<std::string>& hosts);

/// Refuses what a page of another site may have made a browser send with its cookie. Browsers say where a request comes from: Origin
/// where it changes something (every method but GET and HEAD), and newer ones Sec-Fetch-Site always. Comes after check_request.
std::optional<HttpResponse> check_browser(const HttpRequest& request);

}  // namespace prismesh::intake
