// A whole prismesh-intake on a port of its own, with tokens, and requests to it.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/intake/intake.h"
#include "tests/daemon/intake/tls_client.h"

namespace prismesh::intake {

using TestHeaders = std::vector<std::pair<std::string, std::string>>;

class IntakeRig {
 public:
  explicit IntakeRig(const std::function<void(IntakeOptions&)>& change = {}) {
    std::string name = (std::filesystem::temp_directory_path() / "prismesh_intake_XXXXXX").string();
    root_ = ::mkdtemp(name.data());
    options_.state_directory = root_ / "state";
    options_.store = root_ / "state" / "store";
    options_.store_limits.reserved_bytes = 0;
    options_.hosts = {"station.example"};
    if (change) change(options_);
    start();
  }
  ~IntakeRig() {
    stop();
    std::filesystem::remove_all(root_);
  }
  IntakeRig(const IntakeRig&) = delete;
  IntakeRig& operator=(const IntakeRig&) = delete;

  void start() {
    Result<std::unique_ptr<Intake>> started = Intake::start(options_);
    ASSERT_TRUE(started) << started.error().text();
    intake = std::move(*started);
    serving_ = std::thread([this] { intake->run(); });
  }
  void stop() {
    if (!intake) return;
    intake->stop();
    serving_.join();
    intake.reset();
  }

  TlsClient connect() const { return TlsClient(intake->port()); }

  /// A token with these rights, by pairing.
  std::string token(const std::string& name, const Scopes& scopes) const {
    PairingOffer offer{name, scopes};
    const auto secret = intake->access().make_secret(offer);
    const Result<NewToken> made = intake->access().pair(ipc::encode_pairing_secret(secret), "");
    EXPECT_TRUE(made) << made.error().text();
    return made ? made->token : "";
  }

  /// The text of a request. A body gives it its length.
  static std::string request(const std::string& method, const std::string& target, const TestHeaders& headers = {},
                             const std::string& body = "") {
    std::string text = method + " " + target + " HTTP/1.1\r\n";
    bool has_host = false;
    for (const auto& [name, value] : headers) {
      text += name + ": " + value + "\r\n";
      has_host = has_host || name == "Host";
    }
    if (!has_host) text += "Host: localhost\r\n";
    if (!body.empty()) text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
    return text + "\r\n" + body;
  }
  /// One request on a connection of its own.
  TestResponse ask(const std::string& method, const std::string& target, const TestHeaders& headers = {},
                   const std::string& body = "") const {
    TlsClient client = connect();
    client.send(request(method, target, headers, body));
    return client.receive(method == "HEAD");
  }
  static TestHeaders with_token(const std::string& token, TestHeaders headers = {}) {
    headers.emplace_back("Authorization", "Bearer " + token);
    return headers;
  }
  static TestHeaders of_tus(const std::string& token, TestHeaders headers = {}) {
    headers.emplace_back("Tus-Resumable", "1.0.0");
    return with_token(token, std::move(headers));
  }

  /// Begins an upload; its path.
  std::string begin_upload(const std::string& token, std::size_t bytes, const TestHeaders& more = {}) const {
    TestHeaders headers = of_tus(token, more);
    headers.emplace_back("Upload-Length", std::to_string(bytes));
    const TestResponse begun = ask("POST", "/uploads", headers);
    EXPECT_EQ(begun.status, 201u) << begun.body;
    return begun.header("location");
  }
  TestResponse send_chunk(const std::string& token, const std::string& upload, std::size_t offset, const std::string& bytes,
                          const TestHeaders& more = {}) const {
    TestHeaders headers = of_tus(token, more);
    headers.emplace_back("Upload-Offset", std::to_string(offset));
    headers.emplace_back("Content-Type", "application/offset+octet-stream");
    return ask("PATCH", upload, headers, bytes);
  }
  std::size_t offset(const std::string& token, const std::string& upload) const {
    const TestResponse shown = ask("HEAD", upload, of_tus(token));
    EXPECT_EQ(shown.status, 200u);
    return shown.status == 200 ? static_cast<std::size_t>(std::stoull(shown.header("upload-offset"))) : 0;
  }

  std::unique_ptr<Intake> intake;
  const std::filesystem::path& root() const { return root_; }
  const IntakeOptions& options() const { return options_; }

 private:
  std::filesystem::path root_;
  IntakeOptions options_;
  std::thread serving_;
};

}  // namespace prismesh::intake
