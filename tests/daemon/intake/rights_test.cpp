// Who may do what: every route and method, with and without tokens, by every way in which a token might be smuggled.
#include <fstream>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "base/base64.h"
#include "daemon/intake/api/openapi.h"
#include "daemon/intake/http/routes.h"
#include "tests/daemon/intake/intake_rig.h"
#include "tests/daemon/intake/store_rig.h"

namespace prismesh::intake {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string>& methods() {
  static const std::vector<std::string> kMethods{"GET",     "HEAD",  "POST",    "PUT",      "PATCH", "DELETE",
                                                 "OPTIONS", "TRACE", "CONNECT", "PROPFIND", "ANY"};
  return kMethods;
}

/// A path that fits the route.
std::string path_of(const Route& route) {
  std::string path;
  for (std::string_view rest = route.path; !rest.empty();) {
    const std::size_t brace = rest.find('{');
    path += rest.substr(0, brace);
    if (brace == std::string_view::npos) break;
    path += std::string(64, 'a');
    rest.remove_prefix(rest.find('}') + 1);
  }
  return path;
}

/// Of all routes, and some that there aren't.
std::set<std::string> paths() {
  std::set<std::string> all{"/page",   "/page/", "/page/nothing",    "/nothing",  "/models/",   "/uploads/a/b", "/health/",
                            "/pair/x", "/.",     "/token/../health", "/%68ealth", "/models%2fx"};
  for (const Route& route : routes()) all.insert(path_of(route));
  return all;
}

/// What strangers may see, written out: the table of routes isn't asked.
bool is_open(const std::string& method, const std::string& path) {
  static const std::set<std::string> kPage{
      "/",
      "/page/asking.js",
      "/page/catalogue.js",
      "/page/elements.js",
      "/page/fetching.js",
      "/page/icon.svg",
      "/page/main.js",
      "/page/memory.js",
      "/page/pairing.js",
      "/page/sending.js",
      "/page/sha256.js",
      "/page/style.css",
      "/page/upload.js",
      "/page/zip.js",
  };
  const bool reads = method == "GET" || method == "HEAD";
  return (reads && (path == "/health" || kPage.contains(path))) || (method == "POST" && path == "/pair");
}

TEST(Rights, are_needed_for_all_but_the_page_pairing_and_health) {
  const IntakeRig rig;
  const std::string token = rig.token("ann", Scopes::all());
  const std::vector<TestHeaders> none{
      {},
      {{"Authorization", "Bearer " + token.substr(0, token.size() - 1)}},
      {{"Authorization", "Bearer " + token + "0"}},
      {{"Authorization", "bearer"}},
      {{"Authorization", "Basic " + token}},
      {{"Authorization", ""}},
      {{"Cookie", "token=" + token}, {"X-Api-Key", token}, {"X-Forwarded-For", "127.0.0.1"}, {"X-Forwarded-User", "ann"}},
      {{"Cookie", "__Host-prismesh=" + token + "0"}, {"Origin", "https://localhost"}},
      {{"Cookie", "__host-prismesh=" + token}, {"Origin", "https://localhost"}},
      {{"Cookie", "__Host-prismesh=" + token + "; __Host-prismesh=" + token}, {"Origin", "https://localhost"}},
      {{"Cookie", "__Host-prismesh=" + token}, {"Authorization", "Bearer x"}, {"Origin", "https://localhost"}},
  };
  std::size_t tried = 0;
  for (const std::string& path : paths())
    for (const std::string& method : methods()) {
      if (is_open(method, path)) continue;
      TlsClient client = rig.connect();
      for (const TestHeaders& headers : none) {
        ASSERT_TRUE(client.send(rig.request(method, path, headers)));
        const TestResponse response = client.receive(method == "HEAD");
        ASSERT_EQ(response.status, 401u) << method << " " << path << " " << response.body;
        ++tried;
      }
      ASSERT_TRUE(client.send(rig.request(method, path + "?token=" + token + "&access_token=" + token)));
      ASSERT_EQ(client.receive(method == "HEAD").status, 401u) << method << " " << path;
      const TestResponse by_body = rig.ask(method, path, {{"Content-Type", "application/json"}}, "{\"token\": \"" + token + "\"}");
      ASSERT_EQ(by_body.status, 401u) << method << " " << path;
    }
  EXPECT_GT(tried, 1000u);
}

TEST(Rights, of_a_token_are_its_scopes) {
  const IntakeRig rig;
  for (std::size_t i = 0; i < kScopeNames.size(); ++i) {
    Scopes one;
    one.add(static_cast<Scope>(i));
    const std::string token = rig.token(std::string(kScopeNames[i]), one);
    TlsClient client = rig.connect();
    for (const Route& route : routes()) {
      if (route.access == Route::Access::everybody || route.operation == Operation::give_token_up ||
          route.operation == Operation::follow_events)
        continue;
      TestHeaders headers = rig.of_tus(token);
      const bool has_body = route.max_body > 0;
      if (has_body) headers.emplace_back("Content-Type", route.body_type);
      ASSERT_TRUE(client.send(rig.request(std::string(route.method), path_of(route), headers)));
      const TestResponse response = client.receive(route.method == "HEAD");
      if (route.scope && !one.has(*route.scope))
        EXPECT_EQ(response.status, 403u) << route.method << " " << route.path << " with " << kScopeNames[i];
      else
        EXPECT_TRUE(response.status != 403 && response.status != 401 && response.status != 0)
            << route.method << " " << route.path << response.status;
    }
  }
}

TEST(Rights, are_checked_again_when_an_upload_and_a_publication_complete) {
  const IntakeRig rig;
  const std::string token = rig.token("ann", Scopes::all());
  const std::string path = rig.begin_upload(token, 10);
  TlsClient client = rig.connect();
  TestHeaders headers =
      rig.of_tus(token, {{"Upload-Offset", "0"}, {"Content-Type", "application/offset+octet-stream"}, {"Content-Length", "10"}});
  ASSERT_TRUE(client.send(rig.request("PATCH", path, headers) + "01234"));
  const std::string manifest = ipc::store::encode_manifest(manifest_of({{"a.k", "0123456789"}}, "a.k"));
  TlsClient publisher = rig.connect();
  ASSERT_TRUE(publisher.send(rig.request(
      "POST", "/models",
      rig.with_token(token, {{"Content-Type", "application/x-prismesh-set"}, {"Content-Length", std::to_string(manifest.size())}}))));
  // Both requests have begun when the health of another is answered on their thread.
  for (int i = 0; i < 3; ++i) ASSERT_EQ(rig.ask("GET", "/health").status, 200u);
  ASSERT_TRUE(rig.intake->access().revoke("ann"));
  ASSERT_TRUE(client.send("56789"));
  EXPECT_EQ(client.receive().status, 401u);
  ASSERT_TRUE(publisher.send(manifest));
  EXPECT_EQ(publisher.receive().status, 401u);
}

TEST(Rights, end_with_the_token) {
  const IntakeRig rig;
  const std::string token = rig.token("ann", Scopes::all());
  EXPECT_EQ(rig.ask("GET", "/models", rig.with_token(token)).status, 200u);
  EXPECT_EQ(rig.ask("DELETE", "/token", rig.with_token(token)).status, 204u);
  EXPECT_EQ(rig.ask("GET", "/models", rig.with_token(token)).status, 401u);
}

TEST(Pairing, gives_a_token_for_a_secret_once) {
  const IntakeRig rig;
  Scopes reading;
  reading.add(Scope::read);
  const Result<ipc::PairingCode> code = ipc::decode_pairing_code(rig.intake->make_pairing_code({"", reading}));
  ASSERT_TRUE(code);
  EXPECT_TRUE(std::equal(code->fingerprint.begin(), code->fingerprint.end(), rig.connect().fingerprint().bytes.begin()))
      << "80 bits of the certificate";
  const auto pair = [&](const std::string& secret, const std::string& name) {
    return rig.ask("POST", "/pair", {{"Content-Type", "application/json"}}, "{\"secret\": \"" + secret + "\", \"name\": \"" + name + "\"}");
  };
  EXPECT_EQ(pair("0000-0000-0000-0000", "ann").status, 403u);
  const std::string secret = ipc::encode_pairing_secret(code->secret);
  EXPECT_EQ(pair(secret, "").status, 403u) << "no name";
  const TestResponse paired = pair(secret, "ann's laptop");
  ASSERT_EQ(paired.status, 200u) << paired.body;
  const auto answer = nlohmann::json::parse(paired.body);
  EXPECT_EQ(answer["scopes"], nlohmann::json({"read"}));
  EXPECT_EQ(rig.ask("GET", "/models", rig.with_token(answer["token"])).status, 200u);
  EXPECT_EQ(pair(secret, "bob").status, 403u) << "it is used";
  for (const char* body : {"", "{", "[]", "{\"secret\": 5}", "{\"name\": \"x\"}"})
    EXPECT_NE(rig.ask("POST", "/pair", {{"Content-Type", "application/json"}}, body).status, 200u);
}

TEST(Requests, are_refused_where_they_are_not_what_they_seem) {
  const IntakeRig rig;
  const std::string token = rig.token("ann", Scopes::all());
  const auto status = [&](const std::string& method, const std::string& target, TestHeaders headers, const std::string& body = "") {
    return rig.ask(method, target, rig.with_token(token, std::move(headers)), body).status;
  };
  EXPECT_EQ(status("GET", "/models", {{"Host", "evil.example"}}), 421u) << "a name bound anew to this address";
  EXPECT_EQ(status("GET", "/models", {{"Host", "station.example:7443"}}), 200u);
  EXPECT_EQ(status("GET", "/models", {{"Host", "STATION.example"}}), 200u);
  EXPECT_EQ(status("GET", "/models", {{"Host", "10.1.2.3:7443"}}), 200u);
  EXPECT_EQ(status("GET", "/models", {{"Host", "[::1]:7443"}}), 200u);
  EXPECT_EQ(status("GET", "/models", {{"Host", "localhost"}, {"Host", "evil.example"}}), 400u);
  EXPECT_EQ(status("GET", "/models", {{"Host", "localhost@evil.example"}}), 400u);
  EXPECT_EQ(status("GET", "/models", {{"Host", ""}}), 400u);
  EXPECT_EQ(status("GET", "/models", {{"Origin", "https://evil.example"}}), 403u);
  EXPECT_EQ(status("GET", "/models", {{"Origin", "null"}}), 403u);
  EXPECT_EQ(status("GET", "/models", {{"Origin", "http://localhost"}}), 403u);
  EXPECT_EQ(status("GET", "/models", {{"Origin", "https://localhost"}}), 200u);
  EXPECT_EQ(status("POST", "/models", {{"X-HTTP-Method-Override", "DELETE"}}), 400u);
  EXPECT_EQ(status("GET", "/models", {{"Authorization", "Bearer x"}}), 400u) << "two of them";
  EXPECT_EQ(status("GET", "/models", {{"Transfer-Encoding", "chunked"}}), 411u);
  EXPECT_EQ(status("GET", "/models", {{"Content-Encoding", "gzip"}}), 415u);
  EXPECT_EQ(status("GET", "/models?name=a&name=b", {}), 400u);
  EXPECT_EQ(status("GET", "/models?other=1", {}), 400u);
  EXPECT_EQ(status("GET", "/models?count=1001", {}), 400u);
  EXPECT_EQ(status("GET", "/metrics?x=1", {}), 400u);
  EXPECT_EQ(status("GET", "http://localhost/models", {}), 400u);
  EXPECT_EQ(status("GET", "//models", {}), 400u);
  EXPECT_EQ(status("PUT", "/models", {}), 405u);
  EXPECT_EQ(status("GET", "/models", {}, "a body"), 413u);
  EXPECT_EQ(status("POST", "/models", {{"Content-Type", "multipart/form-data; boundary=x"}}, "--x"), 415u);
  EXPECT_EQ(status("POST", "/models", {{"Content-Type", "application/x-prismesh-set"}}, "no manifest"), 400u);
  EXPECT_EQ(status("POST", "/models", {{"Content-Type", "application/x-prismesh-set"}}, std::string((1 << 20) + 1, 'a')), 413u);
  EXPECT_EQ(status("GET", "/models", {{"X-Long", std::string(20'000, 'a')}}), 431u);
}

TEST(Requests, that_are_smuggled_get_no_answer_of_their_own) {
  const IntakeRig rig;
  const std::string token = rig.token("ann", Scopes::all());
  const std::string hidden = rig.request("GET", "/models", rig.with_token(token));
  const std::string authorised = "Host: localhost\r\nAuthorization: Bearer " + token + "\r\n";
  for (const std::string& first :
       {"GET /health HTTP/1.1\r\n" + authorised + "Content-Length: 5\r\nContent-Length: 0\r\n\r\n",
        "GET /health HTTP/1.1\r\n" + authorised + "Content-Length: 0\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
        "GET /health HTTP/1.1\r\n" + authorised + "Transfer-Encoding: chunked\r\nContent-Length: 5\r\n\r\n0\r\n\r\n",
        "GET /health HTTP/1.1\r\n" + authorised + "Transfer-Encoding : chunked\r\n\r\n0\r\n\r\n",
        "GET /health HTTP/1.1\r\n" + authorised + "Content-Length: +5\r\n\r\n",
        "GET /health HTTP/1.1\r\n" + authorised + "Content-Length: 500\r\n\r\n",
        "GET /health HTTP/1.1\r\n" + authorised + "X: a\nTransfer-Encoding: chunked\r\n\r\n",
        std::string("GET /health HTTP/1.1\r\nHost: local\0host\r\n\r\n", 43)}) {
    TlsClient client = rig.connect();
    client.send(first + hidden);
    EXPECT_GE(client.receive().status, 400u) << first;
    EXPECT_EQ(client.receive().status, 0u) << "the connection ends: " << first;
  }
}

TEST(Requests, that_come_too_slowly_are_cut) {
  const IntakeRig rig([](IntakeOptions& options) {
    options.server.greeting = std::chrono::milliseconds(200);
    options.server.idle = std::chrono::milliseconds(200);
    options.server.piece = std::chrono::milliseconds(200);
  });
  const std::string token = rig.token("ann", Scopes::all());
  TlsClient header = rig.connect();
  ASSERT_TRUE(header.send("GET /health HT"));
  EXPECT_EQ(header.receive().status, 0u);
  TlsClient idle = rig.connect();
  EXPECT_EQ(idle.receive().status, 0u);
  const std::string path = rig.begin_upload(token, 1000);
  TlsClient body = rig.connect();
  ASSERT_TRUE(body.send(
      rig.request(
          "PATCH", path,
          rig.of_tus(token, {{"Upload-Offset", "0"}, {"Content-Type", "application/offset+octet-stream"}, {"Content-Length", "1000"}})) +
      "some"));
  EXPECT_EQ(body.receive().status, 0u);
  EXPECT_EQ(rig.offset(token, path), 4u) << "what came counts";
}

TEST(Requests, of_one_token_have_a_rate) {
  const IntakeRig rig([](IntakeOptions& options) {
    options.access_limits.requests_at_once = 5;
    options.access_limits.requests_per_s = 0.001;
  });
  const std::string token = rig.token("ann", Scopes::all());
  for (int i = 0; i < 5; ++i) EXPECT_EQ(rig.ask("GET", "/models", rig.with_token(token)).status, 200u);
  const TestResponse refused = rig.ask("GET", "/models", rig.with_token(token));
  EXPECT_EQ(refused.status, 429u);
  EXPECT_NE(refused.header("retry-after"), "");
  EXPECT_EQ(rig.ask("GET", "/models", rig.with_token(rig.token("bob", Scopes::all()))).status, 200u) << "another's isn't used up";
}

TEST(Requests, cannot_reach_a_file_by_its_path) {
  const IntakeRig rig;
  const std::string token = rig.token("ann", Scopes::all());
  TlsClient client = rig.connect();
  for (const char* target : {"/models/../state/tokens", "/models/..%2f..%2ftokens", "/uploads/..", "/uploads/tokens", "/uploads/....",
                             "/models/%2e%2e/files/x", "/uploads/identity.pem",
                             "/models/"
                             "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"
                             "/files/../../x"}) {
    ASSERT_TRUE(client.send(rig.request("HEAD", target, rig.of_tus(token))));
    const TestResponse response = client.receive(true);
    EXPECT_TRUE(response.status == 404 || response.status == 405 || response.status == 400) << target << " " << response.status;
  }
}

/// The description of the routes, and the table that is served, say the same.
TEST(OpenApi, describes_each_route) {
  const auto described = nlohmann::json::parse(openapi_text());
  const IntakeRig rig;
  EXPECT_EQ(nlohmann::json::parse(rig.ask("GET", "/openapi.json", rig.with_token(rig.token("ann", Scopes::all()))).body), described);
  std::set<std::string> in_table, in_description;
  for (const auto& [path, operations] : described["paths"].items())
    for (const auto& [method, operation] : operations.items()) in_description.insert(method + " " + path);
  for (const Route& route : routes()) {
    std::string method(route.method);
    for (char& c : method) c = static_cast<char>(c - 'A' + 'a');
    in_table.insert(method + " " + std::string(route.path));
    const auto& operation = described["paths"][std::string(route.path)][method];
    EXPECT_EQ(operation.contains("security"), route.access == Route::Access::everybody) << route.path;
    EXPECT_EQ(operation.value("x-scope", ""), route.scope ? kScopeNames[static_cast<std::size_t>(*route.scope)] : "") << route.path;
    EXPECT_EQ(operation.contains("requestBody"), route.max_body > 0) << route.path;
    if (route.max_body > 0) {
      EXPECT_TRUE(operation["requestBody"]["content"].contains(std::string(route.body_type))) << route.path;
    }
    if (route.max_body > 0 && route.operation != Operation::continue_upload) {
      EXPECT_EQ(operation["requestBody"]["x-max-bytes"], route.max_body) << route.path;
    }
    std::size_t parts = 0;
    for (const auto& parameter : operation.value("parameters", nlohmann::json::array())) parts += parameter["in"] == "path" ? 1 : 0;
    EXPECT_EQ(parts, static_cast<std::size_t>(std::count(route.path.begin(), route.path.end(), '{'))) << route.path;
  }
  EXPECT_EQ(in_table, in_description);
}

}  // namespace
}  // namespace prismesh::intake
