#include "ipc/import/client.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <iterator>
#include <new>
#include <optional>
#include <utility>

#include "ipc/import/hand_over.h"
#include "ipc/import/messages_json.h"
#include "ipc/import/model_change.h"
#include "ipc/import/text_hand_over.h"
#include "ipc/wire/descriptor.h"
#include "ipc/wire/failure.h"
#include "ipc/wire/line_socket.h"

namespace prismesh::ipc {

namespace {

using Clock = std::chrono::steady_clock;

/// An answer is short: the deck comes in memory.
constexpr LineLimits kAnswerLimits{1 << 20, 1};
constexpr std::chrono::milliseconds kGlance{100};
constexpr std::uint64_t kBlockBytes = 512;  ///< of stat, whatever the file system's own are
constexpr int kAllSeals = F_SEAL_WRITE | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL;

/// A process that is killed when it isn't needed any more. Of one that the service manager starts, the id isn't known; it ends with its
/// connection.
class ImportProcess {
 public:
  explicit ImportProcess(pid_t id) : id_(id) {}
  ImportProcess(const ImportProcess&) = delete;
  ImportProcess& operator=(const ImportProcess&) = delete;
  ImportProcess(ImportProcess&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  ~ImportProcess() {
    if (id_ <= 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }
  bool is_child() const { return id_ > 0; }
  /// Waits for its end. Returns its wait status.
  int wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = 0;
    return status;
  }

 private:
  pid_t id_;
};

/// Starts the program with the socket as its standard input.
Result<pid_t> start(const std::filesystem::path& program, const Descriptor& socket) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, socket.get(), STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  std::string name = program.string();
  std::array<char*, 2> arguments{name.data(), nullptr};
  pid_t child = 0;
  const int error = ::posix_spawn(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return fail(program.string(), std::string("could not be started: ") + std::strerror(error));
  return child;
}

/// Why the program ended without an answer.
std::string why_it_ended(ImportProcess& process, const ImportLimits& limits) {
  const std::string reader = "the program that reads it in a sandbox ";
  const std::string consequence = "; it isn't opened, and nothing else was harmed";
  if (!process.is_child())
    return reader + "ended without an answer: it crashed, or took more memory or time than it may; the system's log says which" +
           consequence;
  const int status = process.wait();
  if (WIFEXITED(status)) return reader + "ended without an answer (status " + std::to_string(WEXITSTATUS(status)) + ")" + consequence;
  const int signal = WTERMSIG(status);
  if (signal == SIGXCPU)
    return "reading it takes more than the " + std::to_string(limits.cpu_s) + " seconds of processor time that it may take here" +
           consequence;
  if (signal == SIGKILL) return reader + "was killed: by a user, or by the kernel for want of memory" + consequence;
  return reader + "crashed (" + ::strsignal(signal) + ")" + consequence;
}

Result<void> send(LineSocket& socket, const ImportRequest& request, std::vector<Descriptor> descriptors) {
  Result<std::string> line = encode_import_request(request);
  if (!line) return fail(std::move(line.error()));
  socket.queue(std::move(*line), std::move(descriptors));
  // The line fits into the socket's buffer.
  const Result<bool> sent = socket.flush();
  if (sent && !*sent) return fail("", "the request is too long");
  // A program that ended already is told of by how it ended.
  return {};
}

using FromImport = Said<ImportAnswer, ImportEvent>;

/// The answer; nothing: the program closed the connection. Tells of the progress until then. Errors: a message that can't be read,
/// impatience, cancelled.
Result<std::optional<FromImport>> wait_for_answer(LineSocket& socket, const std::filesystem::path& deck, const ImportOptions& options) {
  const Clock::time_point until = Clock::now() + options.patience;
  double fraction = 0;
  while (Clock::now() < until) {
    if (options.progress && !options.progress(fraction)) return fail(cancelled());
    if (const auto line = socket.next_line()) {
      Result<FromImport> said = decode_from_import(*line);
      if (!said) return fail(std::move(said.error()));
      const auto* event = std::get_if<ImportEvent>(&said->message);
      if (event == nullptr) return std::optional(std::move(*said));
      fraction = std::clamp(std::get<ImportProgress>(*event).fraction, fraction, 1.0);
      continue;
    }
    pollfd watched{socket.descriptor(), POLLIN, 0};
    if (::poll(&watched, 1, static_cast<int>(kGlance.count())) <= 0) continue;
    if (const Result<bool> received = socket.receive(); !received) return std::optional<FromImport>();
  }
  return fail(deck.string(), "reading it takes longer than the " + std::to_string(options.patience.count()) +
                                 " seconds that it may take here; it isn't opened");
}

/// A program that waits for its request.
struct Importer {
  LineSocket socket;
  ImportProcess process;
};

Result<Importer> start_importer(const ImportOptions& options) {
  if (!options.socket.empty()) {
    Result<Descriptor> connected = connect_to(options.socket, "start prismesh-import.socket");
    if (!connected) return fail(std::move(connected.error()));
    return Importer{LineSocket(std::move(*connected), kAnswerLimits), ImportProcess(0)};
  }
  std::array<int, 2> ends{-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) return fail("socket", std::strerror(errno));
  LineSocket socket{Descriptor(ends[0]), kAnswerLimits};
  const Descriptor of_program(ends[1]);  // closed here, else the connection would outlive the program
  const Result<pid_t> started = start(options.program, of_program);
  if (!started) return fail(started.error());
  return Importer{std::move(socket), ImportProcess(*started)};
}

/// Sends the request with the deck's folder and what comes with it, and waits. Returns the memory that the answer hands over, and
/// `unguarded` of it.
template <class Expected>
Result<std::pair<Descriptor, Expected>> ask(const ImportRequest& request, const std::filesystem::path& deck, std::vector<Descriptor> more,
                                            const ImportOptions& options) {
  const std::filesystem::path folder = deck.parent_path();
  if (!deck.has_filename()) return fail(deck.string(), "is a folder, not a file");
  std::vector<Descriptor> descriptors;
  descriptors.emplace_back(::open(folder.empty() ? "." : folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!descriptors.front()) return fail(deck.string(), std::string("its folder can't be opened: ") + std::strerror(errno));
  std::move(more.begin(), more.end(), std::back_inserter(descriptors));
  Result<Importer> importer = start_importer(options);
  if (!importer) return fail(std::move(importer.error()));
  if (Result<void> sent = send(importer->socket, request, std::move(descriptors)); !sent) return fail(std::move(sent.error()));
  Result<std::optional<FromImport>> said = wait_for_answer(importer->socket, deck, options);
  if (!said) return fail(std::move(said.error()));
  if (!*said) return fail(deck.string(), why_it_ended(importer->process, options.limits));
  auto& answer = std::get<ImportAnswer>((*said)->message);
  if (const auto* failed = std::get_if<Failed>(&answer)) return fail(error_from(*failed));
  auto* expected = std::get_if<Expected>(&answer);
  Result<std::vector<Descriptor>> memory = importer->socket.take_descriptors((*said)->descriptors);
  if (!memory) return fail(std::move(memory.error()));
  if (expected == nullptr || memory->size() != 1) return fail("message from prismesh-import", "it comes without what was asked for");
  return std::pair(std::move(memory->front()), std::move(*expected));
}

/// What was handed over, once it can't change any more.
Result<Mapping> sealed_bytes(const Descriptor& memory, const std::string& what, const ImportLimits& limits) {
  const int seals = ::fcntl(memory.get(), F_GET_SEALS);
  if (seals < 0 || (seals & kAllSeals) != kAllSeals)
    return fail(what, "its memory isn't sealed, so it could change while it is read; it isn't used");
  struct stat status {};
  if (::fstat(memory.get(), &status) != 0 || static_cast<std::uint64_t>(status.st_size) > limits.memory_bytes)
    return fail(what, "it is larger than the program that read it may be; it isn't used");
  // Memory that was never written costs its maker nothing, and its reader all of it.
  if (static_cast<std::uint64_t>(status.st_blocks) * kBlockBytes < static_cast<std::uint64_t>(status.st_size))
    return fail(what, "parts of it were never written; it isn't used");
  return Mapping::map(memory, false);
}

Result<mesh::deck::OpenedDeck> take_over(const Descriptor& memory, const Import& request) {
  const std::string what = "the deck as it was handed over";
  const Result<Mapping> mapping = sealed_bytes(memory, what, request.limits);
  if (!mapping) return fail(mapping.error());
  Result<mesh::deck::OpenedDeck> opened = read_hand_over(mapping->bytes(), request.shown_folder);
  if (opened && opened->deck->files[0].relative != request.main) return fail(what, "it is another deck; it isn't used");
  return opened;
}

Import request_for(const std::filesystem::path& deck, const ImportOptions& options) {
  return {kImportProtocol, deck.filename().string(), deck.parent_path().string(), options.limits, options.stand_ins};
}

}  // namespace

Result<ImportedDeck> import_deck(const std::filesystem::path& deck, const ImportOptions& options) {
  const Import request = request_for(deck, options);
  Result<std::pair<Descriptor, Imported>> answer = ask<Imported>(request, deck, {}, options);
  if (!answer) return fail(std::move(answer.error()));
  try {
    Result<mesh::deck::OpenedDeck> opened = take_over(answer->first, request);
    if (!opened) return fail(std::move(opened.error()));
    return ImportedDeck{std::move(*opened), std::move(answer->second.unguarded)};
  } catch (const std::bad_alloc&) {
    return fail(deck.string(), "there isn't enough memory to take it over; it isn't opened");
  }
}

Result<mesh::deck::TextChanges> rewrite_deck(const mesh::deck::Deck& deck, const mesh::Model& original, const mesh::Model& model,
                                             const ImportOptions& options) {
  const std::filesystem::path& path = deck.files[0].path;
  Result<Descriptor> change = make_sealed_memory("change", write_model_change(original, model));
  if (!change) return fail(std::move(change.error()));
  std::vector<Descriptor> more;
  more.push_back(std::move(*change));
  const Rewrite request{request_for(path, options), deck.content.hex()};
  Result<std::pair<Descriptor, Rewritten>> answer = ask<Rewritten>(request, path, std::move(more), options);
  if (!answer) return fail(std::move(answer.error()));
  try {
    const Result<Mapping> bytes = sealed_bytes(answer->first, "the new text as it was handed over", options.limits);
    if (!bytes) return fail(bytes.error());
    return read_text_hand_over(bytes->bytes(), deck, model.node_count());
  } catch (const std::bad_alloc&) {
    return fail(path.string(), "there isn't enough memory to take its new text over; nothing is written");
  }
}

}  // namespace prismesh::ipc
