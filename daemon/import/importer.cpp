#include "daemon/import/importer.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "daemon/import/confined_files.h"
#include "daemon/import/sandbox.h"
#include "ipc/import/hand_over.h"
#include "ipc/import/messages_json.h"
#include "ipc/import/model_change.h"
#include "ipc/import/text_hand_over.h"
#include "ipc/wire/failure.h"
#include "ipc/wire/line_socket.h"
#include "mesh/deck/editing/text_changes.h"
#include "mesh/deck/open.h"

namespace prismesh::importer {

namespace {

constexpr ipc::LineLimits kRequestLimits{64 << 10, 2};
constexpr double kProgressStep = 0.03;

struct ImportJob {
  ipc::ImportRequest request;
  ipc::Descriptor folder;
  std::vector<std::byte> change;  ///< of the model, to rewrite the deck

  const ipc::Import& what() const {
    if (const auto* rewrite = std::get_if<ipc::Rewrite>(&request)) return *rewrite;
    return std::get<ipc::Import>(request);
  }
  std::filesystem::path path() const { return std::filesystem::path(what().shown_folder) / what().main; }
};

void wait_for(const ipc::LineSocket& socket, short what) {
  pollfd watched{socket.descriptor(), what, 0};
  ::poll(&watched, 1, -1);
}

Result<ImportJob> receive_request(ipc::LineSocket& socket) {
  std::optional<std::string_view> line = socket.next_line();
  while (!line) {
    wait_for(socket, POLLIN);
    if (Result<bool> received = socket.receive(); !received) return fail(std::move(received.error()));
    line = socket.next_line();
  }
  Result<ipc::ImportRequest> request = ipc::decode_import_request(*line);
  if (!request) return fail(std::move(request.error()));
  const bool rewrites = std::holds_alternative<ipc::Rewrite>(*request);
  Result<std::vector<ipc::Descriptor>> given = socket.take_descriptors(rewrites ? 2 : 1);
  if (!given) return fail(std::move(given.error()));
  ImportJob job{std::move(*request), std::move(given->front()), {}};
  if (job.what().protocol != ipc::kImportProtocol)
    return fail("request", "prismesh-import and who asks it are of different versions; use programs of one version");
  if (!rewrites) return job;
  const Result<ipc::Mapping> change = ipc::Mapping::map(given->back(), false);
  if (!change) return fail(change.error());
  job.change.assign(change->bytes().begin(), change->bytes().end());
  return job;
}

/// Memory that can only become shorter once the process is locked in. Its pages exist only when they are written.
Result<ipc::Descriptor> make_memory(std::uint64_t max_bytes) {
  ipc::Descriptor memory(::memfd_create("deck", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!memory || ::ftruncate(memory.get(), static_cast<off_t>(max_bytes)) != 0)
    return fail("", std::string("no memory to hand the deck over in: ") + std::strerror(errno));
  return memory;
}

tl::unexpected<Error> too_large(const std::string& path, const ipc::ImportLimits& limits) {
  return fail(path, "reading it needs more than the " + std::to_string(limits.memory_bytes >> 20) + " MB of memory that it may take here");
}

/// Gives the memory `size` bytes, has them written, and seals it.
template <class Write>
Result<void> fill(const ipc::Descriptor& memory, std::size_t size, const std::string& path, const ipc::ImportLimits& limits,
                  const Write& write) {
  if (size > limits.memory_bytes) return too_large(path, limits);
  if (::ftruncate(memory.get(), static_cast<off_t>(size)) != 0)
    return fail(path, std::string("can't be handed over: ") + std::strerror(errno));
  void* mapped = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, memory.get(), 0);
  if (mapped == MAP_FAILED) return too_large(path, limits);
  write(std::span(static_cast<std::byte*>(mapped), size));
  // A mapping that can write would forbid the seal.
  ::munmap(mapped, size);
  if (::fcntl(memory.get(), F_ADD_SEALS, F_SEAL_WRITE | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0)
    return fail(path, std::string("can't be sealed: ") + std::strerror(errno));
  return {};
}

/// Sends the progress in steps of some hundredths: few enough to wait in the socket, where nobody reads them.
Progress told_to(ipc::LineSocket& socket) {
  return [&socket, told = 0.0](double fraction) mutable {
    if (fraction < told + kProgressStep) return true;
    told = fraction;
    socket.queue(ipc::encode_import_event(ipc::ImportProgress{fraction}));
    return socket.flush().has_value();
  };
}

mesh::deck::StandIns stand_ins_of(const ipc::Import& request, const ConfinedFiles& files) {
  const std::filesystem::path folder = request.shown_folder;
  mesh::deck::StandIns stand_ins;
  for (const ipc::StandIn& each : request.stand_ins) stand_ins[files.canonical_name(folder / each.of)] = folder / each.file;
  return stand_ins;
}

/// The text that the edited model needs.
Result<mesh::deck::TextChanges> rewritten(const ImportJob& job, const mesh::deck::OpenedDeck& opened) {
  const std::string path = job.path().string();
  if (opened.deck->content.hex() != std::get<ipc::Rewrite>(job.request).content)
    return fail(path, "has changed on disk since it was opened; nothing was written");
  const Result<mesh::Model> model = ipc::read_model_change(job.change, opened.model);
  if (!model) return fail(model.error());
  return mesh::deck::text_changes(*opened.deck, opened.model, *model);
}

/// Reads the deck and fills the memory with it, or with what its edits make of its text.
Result<void> work(const ImportJob& job, ipc::LineSocket& socket, const ipc::Descriptor& memory) {
  const ipc::ImportLimits& limits = job.what().limits;
  const std::string path = job.path().string();
  try {
    const ConfinedFiles files(job.folder.get(), job.what().shown_folder);
    const mesh::deck::ReadingLimits reading{limits.files, limits.text_bytes, limits.nodes, limits.elements};
    const Result<mesh::deck::OpenedDeck> opened =
        mesh::deck::open_within(files, reading, job.path(), told_to(socket), stand_ins_of(job.what(), files));
    if (!opened) return fail(opened.error());
    if (std::holds_alternative<ipc::Import>(job.request))
      return fill(memory, ipc::hand_over_size(*opened), path, limits,
                  [&](std::span<std::byte> out) { ipc::write_hand_over(*opened, out); });
    const Result<mesh::deck::TextChanges> text = rewritten(job, *opened);
    if (!text) return fail(text.error());
    const std::vector<std::byte> bytes = ipc::write_text_hand_over(*text);
    return fill(memory, bytes.size(), path, limits, [&](std::span<std::byte> out) { std::copy(bytes.begin(), bytes.end(), out.begin()); });
  } catch (const std::bad_alloc&) {
    return too_large(path, limits);
  }
}

Result<void> send(ipc::LineSocket& socket, const ipc::ImportAnswer& answer, std::vector<ipc::Descriptor> descriptors = {}) {
  const std::size_t count = descriptors.size();
  socket.queue(ipc::encode_import_answer(answer, count), std::move(descriptors));
  for (;;) {
    Result<bool> sent = socket.flush();
    if (!sent) return fail(std::move(sent.error()));
    if (*sent) return {};
    wait_for(socket, POLLOUT);
  }
}

}  // namespace

Result<void> serve(ipc::Descriptor descriptor) {
  ipc::LineSocket socket(std::move(descriptor), kRequestLimits);
  const auto refuse = [&](const Error& error) { return send(socket, ipc::failed_from(error)); };
  const Result<ImportJob> job = receive_request(socket);
  if (!job) return refuse(job.error());
  const ipc::ImportLimits& limits = job->what().limits;
  Result<ipc::Descriptor> memory = make_memory(limits.memory_bytes);
  if (!memory) return refuse(memory.error());
  Result<std::vector<std::string>> unguarded =
      lock_in({job->folder.get(), socket.descriptor(), memory->get()}, {limits.memory_bytes, limits.cpu_s});
  if (!unguarded) return refuse(unguarded.error());
  if (const Result<void> done = work(*job, socket, *memory); !done) return refuse(done.error());
  std::vector<ipc::Descriptor> handed;
  handed.push_back(std::move(*memory));
  if (std::holds_alternative<ipc::Rewrite>(job->request)) return send(socket, ipc::Rewritten{std::move(*unguarded)}, std::move(handed));
  return send(socket, ipc::Imported{std::move(*unguarded)}, std::move(handed));
}

}  // namespace prismesh::importer
