// The page's files, and a browser's cookie: what it opens, and what pages of other sites can't do with it.
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "daemon/intake/api/page.h"
#include "daemon/intake/http/routes.h"
#include "tests/daemon/intake/intake_rig.h"

namespace prismesh::intake {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Page, has_a_route_for_each_file_and_a_file_for_each_route) {
  std::vector<std::string_view> files, served;
  for (const PageFile& file : page_files()) files.push_back(file.path);
  for (const Route& route : routes())
    if (route.operation == Operation::show_page) served.push_back(route.path);
  EXPECT_THAT(served, ::testing::UnorderedElementsAreArray(files));
}

TEST(Page, comes_whole_with_a_policy_that_lets_nothing_else_in) {
  const IntakeRig rig;
  for (const PageFile& file : page_files()) {
    const TestResponse response = rig.ask("GET", std::string(file.path));
    EXPECT_EQ(response.status, 200u) << file.path;
    EXPECT_EQ(response.body, file.text) << file.path;
    EXPECT_EQ(response.header("content-type"), file.type) << file.path;
    EXPECT_EQ(response.header("x-content-type-options"), "nosniff");
    EXPECT_EQ(response.header("referrer-policy"), "no-referrer");
    EXPECT_EQ(response.header("cross-origin-opener-policy"), "same-origin");
    EXPECT_EQ(response.header("cross-origin-resource-policy"), "same-origin");
    const std::string policy = response.header("content-security-policy");
    for (const char* part : {"default-src 'none'", "script-src 'self'", "frame-ancestors 'none'", "base-uri 'none'", "form-action 'none'"})
      EXPECT_THAT(policy, HasSubstr(part)) << file.path;
    EXPECT_THAT(policy, Not(HasSubstr("unsafe"))) << file.path;
  }
  EXPECT_EQ(rig.ask("GET", "/").header("content-type"), "text/html; charset=utf-8");
  EXPECT_EQ(rig.ask("GET", "/health").header("content-security-policy"), "default-src 'none'; frame-ancestors 'none'");
}

/// A policy would stop them; there must be none in the first place.
TEST(Page, names_nothing_of_other_sites_and_has_no_script_in_its_markup) {
  for (const PageFile& file : page_files()) {
    if (file.type.starts_with("image/")) continue;
    for (const char* foreign : {"http://", "https://", "\"//", "innerHTML", "outerHTML", "eval(", "document.write", "javascript:"})
      EXPECT_THAT(std::string(file.text), Not(HasSubstr(foreign))) << file.path;
  }
  std::string html;
  for (const PageFile& file : page_files())
    if (file.path == "/") html = file.text;
  ASSERT_THAT(html, HasSubstr("<main"));
  EXPECT_THAT(html, Not(::testing::ContainsRegex(" on[a-z]+=")));
  EXPECT_THAT(html, Not(HasSubstr("style=")));
  EXPECT_THAT(html, Not(HasSubstr("<style")));
}

class Cookie : public ::testing::Test {
 protected:
  Cookie() {
    const Result<ipc::PairingCode> code = ipc::decode_pairing_code(rig_.intake->make_pairing_code({"", Scopes::all()}));
    secret_ = ipc::encode_pairing_secret(code->secret);
  }
  TestResponse pair(TestHeaders headers) const {
    headers.emplace_back("Content-Type", "application/json");
    return rig_.ask("POST", "/pair", headers, R"({"secret": ")" + secret_ + R"(", "name": "ann's browser", "cookie": true})");
  }
  /// "__Host-prismesh=TOKEN", as a browser sends it back.
  std::string paired() const {
    const std::string set = pair({{"Origin", "https://localhost"}, {"Sec-Fetch-Site", "same-origin"}}).header("set-cookie");
    return set.substr(0, set.find(';'));
  }
  unsigned status(const std::string& method, const std::string& target, const TestHeaders& headers) const {
    return rig_.ask(method, target, headers).status;
  }

  IntakeRig rig_;
  std::string secret_;
};

TEST_F(Cookie, is_given_to_the_own_page_only_and_hides_the_token) {
  EXPECT_EQ(pair({}).status, 403u) << "no browser says this of itself";
  EXPECT_EQ(pair({{"Origin", "https://evil.example"}}).status, 403u);
  EXPECT_EQ(pair({{"Origin", "https://localhost"}, {"Sec-Fetch-Site", "same-site"}}).status, 403u) << "another port of this machine";
  EXPECT_EQ(pair({{"Origin", "https://localhost"}, {"Sec-Fetch-Site", "none"}}).status, 403u);
  const TestResponse response = pair({{"Origin", "https://localhost"}, {"Sec-Fetch-Site", "same-origin"}});
  ASSERT_EQ(response.status, 200u) << response.body << "; refused requests don't spend the code";
  EXPECT_FALSE(nlohmann::json::parse(response.body).contains("token"));
  const std::string cookie = response.header("set-cookie");
  EXPECT_THAT(cookie, ::testing::StartsWith("__Host-prismesh=pm_"));
  for (const char* part : {"; Path=/", "; Secure", "; HttpOnly", "; SameSite=Strict", "; Max-Age=31536000"})
    EXPECT_THAT(cookie, HasSubstr(part));
  EXPECT_THAT(cookie, Not(HasSubstr("Domain")));
}

TEST_F(Cookie, opens_what_its_token_may_do) {
  const std::string cookie = paired();
  EXPECT_EQ(status("GET", "/models", {{"Cookie", cookie}}), 200u);
  EXPECT_EQ(status("GET", "/models", {{"Cookie", "other=1; " + cookie}, {"Sec-Fetch-Site", "same-origin"}}), 200u);
  EXPECT_EQ(status("GET", "/models", {{"Cookie", cookie}, {"Sec-Fetch-Site", "none"}}), 200u) << "a typed address";
  const TestResponse token = rig_.ask("GET", "/token", {{"Cookie", cookie}});
  EXPECT_EQ(nlohmann::json::parse(token.body)["name"], "ann's browser");
  EXPECT_EQ(nlohmann::json::parse(token.body)["scopes"], (nlohmann::json{"read", "upload", "remove", "metrics"}));
  EXPECT_EQ(status("GET", "/models", {{"Cookie", cookie}, {"Cookie", cookie}}), 400u) << "two of them";
}

TEST_F(Cookie, changes_nothing_for_pages_of_other_sites) {
  const std::string cookie = paired();
  const std::vector<TestHeaders> foreign{
      {{"Cookie", cookie}},
      {{"Cookie", cookie}, {"Origin", "null"}},
      {{"Cookie", cookie}, {"Origin", "https://evil.example"}},
      {{"Cookie", cookie}, {"Origin", "https://localhost:8443"}},
      {{"Cookie", cookie}, {"Sec-Fetch-Site", "same-origin"}},
      {{"Cookie", cookie}, {"Origin", "https://localhost"}, {"Sec-Fetch-Site", "same-site"}},
      {{"Cookie", cookie}, {"Origin", "https://localhost"}, {"Sec-Fetch-Site", "cross-site"}},
      {{"Cookie", cookie}, {"Origin", "https://localhost"}, {"Sec-Fetch-Site", "none"}},
  };
  for (const Route& route : routes()) {
    if (route.method == "GET" || route.method == "HEAD" || route.access == Route::Access::everybody) continue;
    for (TestHeaders headers : foreign) {
      headers.emplace_back("Tus-Resumable", "1.0.0");
      headers.emplace_back("Upload-Length", "5");
      if (!route.body_type.empty()) headers.emplace_back("Content-Type", route.body_type);
      std::string path(route.path);
      for (std::size_t open = path.find('{'); open != std::string::npos; open = path.find('{'))
        path.replace(open, path.find('}') - open + 1, std::string(64, 'a'));
      EXPECT_EQ(status(std::string(route.method), path, headers), 403u) << route.method << " " << path;
    }
  }
  EXPECT_EQ(status("GET", "/models", {{"Cookie", cookie}, {"Sec-Fetch-Site", "cross-site"}}), 403u);
  EXPECT_EQ(status("GET", "/models", {{"Cookie", cookie}, {"Sec-Fetch-Site", "same-site"}}), 403u);
  EXPECT_EQ(status("POST", "/uploads",
                   {{"Cookie", cookie},
                    {"Origin", "https://localhost"},
                    {"Sec-Fetch-Site", "same-origin"},
                    {"Tus-Resumable", "1.0.0"},
                    {"Upload-Length", "5"}}),
            201u);
}

TEST_F(Cookie, ends_with_its_token) {
  const std::string cookie = paired();
  const TestResponse left = rig_.ask("DELETE", "/token", {{"Cookie", cookie}, {"Origin", "https://localhost"}});
  EXPECT_EQ(left.status, 204u);
  EXPECT_THAT(left.header("set-cookie"), ::testing::AllOf(::testing::StartsWith("__Host-prismesh=;"), HasSubstr("; Max-Age=0;")));
  EXPECT_EQ(status("GET", "/models", {{"Cookie", cookie}}), 401u);
}

}  // namespace
}  // namespace prismesh::intake
