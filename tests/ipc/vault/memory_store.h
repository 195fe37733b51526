// A store in memory that speaks the bytes of S3 on loopback, one request a connection, without looking at signatures. A test may answer
// instead.
#pragma once

#include <arpa/inet.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "ipc/vault/vault.h"

namespace prismesh::ipc::vault {

struct SeenRequest {
  std::string method, target, head, body;
};

class MemoryStore {
 public:
  /// Bytes that are sent instead of the store's own answer; nothing: its own.
  using Instead = std::function<std::optional<std::string>(const SeenRequest& request)>;

  MemoryStore() {
    listening_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(listening_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(listening_, 16), 0);
    EXPECT_EQ(::getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
    serving_ = std::thread([this] { serve(); });
  }
  ~MemoryStore() {
    ends_ = true;
    serving_.join();
    ::close(listening_);
  }
  MemoryStore(const MemoryStore&) = delete;
  MemoryStore& operator=(const MemoryStore&) = delete;

  /// Called on the store's thread.
  void answer_instead(Instead instead) {
    const std::lock_guard lock(mutex_);
    instead_ = std::move(instead);
  }
  std::map<std::string, std::string> objects() const {
    const std::lock_guard lock(mutex_);
    return objects_;
  }
  void put(const std::string& key, const std::string& bytes) {
    const std::lock_guard lock(mutex_);
    objects_[key] = bytes;
  }
  std::vector<SeenRequest> requests() const {
    const std::lock_guard lock(mutex_);
    return requests_;
  }
  std::size_t count(const std::string& method) const {
    std::size_t count = 0;
    for (const SeenRequest& request : requests()) count += request.method == method ? 1 : 0;
    return count;
  }

  VaultAddress address() const { return {true, "127.0.0.1", port_, "bucket", "f/"}; }
  /// Tries for `patience` at most.
  Vault vault(std::chrono::milliseconds patience = std::chrono::milliseconds(5000), Stop stop = {}) const {
    VaultOptions options;
    options.retry = {patience, std::chrono::milliseconds(1)};
    options.line.silence = std::chrono::seconds(20);
    return {address(), {std::nullopt, "here", "key", "secret", ""}, options, std::move(stop)};
  }

  static std::string answer(const std::string& status, const std::string& body, const std::string& headers = "") {
    return "HTTP/1.1 " + status + "\r\n" + headers + "Connection: close\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" +
           body;
  }
  static std::string refusal(const std::string& status, const std::string& code) {
    return answer(status, "<?xml version=\"1.0\"?><Error><Code>" + code + "</Code><Message>words</Message></Error>");
  }

 private:
  void serve() {
    sigset_t pipe;
    sigemptyset(&pipe);
    sigaddset(&pipe, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &pipe, nullptr);
    while (!ends_) {
      pollfd waiting{listening_, POLLIN, 0};
      if (::poll(&waiting, 1, 20) != 1) continue;
      const int client = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
      const timeval patience{5, 0};
      ::setsockopt(client, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
      if (std::optional<SeenRequest> request = read_request(client)) {
        std::string said = answer_to(*request);
        for (std::size_t sent = 0; sent < said.size();) {
          const ssize_t some = ::send(client, said.data() + sent, said.size() - sent, MSG_NOSIGNAL);
          if (some <= 0) break;
          sent += static_cast<std::size_t>(some);
        }
      }
      ::close(client);
    }
  }

  static std::optional<SeenRequest> read_request(int client) {
    SeenRequest request;
    std::string& head = request.head;
    char sign = 0;
    while (!head.ends_with("\r\n\r\n")) {
      if (::recv(client, &sign, 1, 0) != 1) return std::nullopt;
      head += sign;
    }
    if (head.find("Expect: 100-continue") != std::string::npos) (void)::send(client, "HTTP/1.1 100 Continue\r\n\r\n", 25, MSG_NOSIGNAL);
    const std::size_t first = head.find(' '), second = head.find(' ', first + 1);
    request.method = head.substr(0, first);
    request.target = head.substr(first + 1, second - first - 1);
    const std::size_t length = head.find("Content-Length: ");
    std::size_t left = length == std::string::npos ? 0 : std::stoul(head.substr(length + 16));
    std::vector<char> some(std::size_t{1} << 20);
    while (left > 0) {
      const ssize_t got = ::recv(client, some.data(), std::min(left, some.size()), 0);
      if (got <= 0) return std::nullopt;
      request.body.append(some.data(), static_cast<std::size_t>(got));
      left -= static_cast<std::size_t>(got);
    }
    return request;
  }

  std::string answer_to(const SeenRequest& request) {
    const std::lock_guard lock(mutex_);
    requests_.push_back(request);
    if (instead_)
      if (std::optional<std::string> said = instead_(request)) return std::move(*said);
    if (request.target.starts_with("/bucket?")) return list(request.target);
    const std::string key = request.target.substr(std::string("/bucket/").size());
    if (request.method == "PUT") {
      objects_[key] = request.body;
      return answer("200 OK", "");
    }
    const auto found = objects_.find(key);
    if (found == objects_.end()) return request.method == "HEAD" ? answer("404 No", "") : refusal("404 No", "NoSuchKey");
    const std::string& bytes = found->second;
    if (request.method == "HEAD")
      return "HTTP/1.1 200 OK\r\nConnection: close\r\nContent-Length: " + std::to_string(bytes.size()) + "\r\n\r\n";
    const std::size_t range = request.head.find("Range: bytes=");
    if (range == std::string::npos) return answer("200 OK", bytes);
    const std::size_t from = std::stoul(request.head.substr(range + 13));
    return answer("206 Part", bytes.substr(from),
                  "Content-Range: bytes " + std::to_string(from) + "-" + std::to_string(bytes.size() - 1) + "/" +
                      std::to_string(bytes.size()) + "\r\n");
  }

  /// At most two objects at once, so that lists go on.
  std::string list(const std::string& target) const {
    const auto value = [&target](const std::string& name) {
      const std::size_t at = target.find(name + "=");
      if (at == std::string::npos) return std::string();
      std::string text = target.substr(at + name.size() + 1);
      text = text.substr(0, text.find('&'));
      for (std::size_t slash = text.find("%2F"); slash != std::string::npos; slash = text.find("%2F")) text.replace(slash, 3, "/");
      return text;
    };
    const std::string prefix = value("prefix"), after = value("continuation-token");
    std::string body = "<?xml version=\"1.0\"?><ListBucketResult xmlns=\"http://s3.amazonaws.com/doc/2006-03-01/\">", last;
    int count = 0;
    bool goes_on = false;
    for (const auto& [key, bytes] : objects_) {
      if (!key.starts_with(prefix) || key <= after) continue;
      goes_on = count++ == 2;
      if (goes_on) break;
      body += "<Contents><Key>" + key + "</Key><Size>" + std::to_string(bytes.size()) + "</Size></Contents>";
      last = key;
    }
    body += goes_on ? "<IsTruncated>true</IsTruncated><NextContinuationToken>" + last + "</NextContinuationToken>"
                    : "<IsTruncated>false</IsTruncated>";
    return answer("200 OK", body + "</ListBucketResult>");
  }

  int listening_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<bool> ends_{false};
  mutable std::mutex mutex_;
  Instead instead_;
  std::map<std::string, std::string> objects_;  ///< by key, the folder included
  std::vector<SeenRequest> requests_;
  std::thread serving_;
};

}  // namespace prismesh::ipc::vault
