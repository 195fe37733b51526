#include "daemon/import/importer.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/import/confined_files.h"
#include "daemon/import/sandbox.h"
#include "ipc/import/hand_over.h"
#include "ipc/import/messages_json.h"
#include "ipc/wire/failure.h"
#include "ipc/wire/line_socket.h"
#include "mesh/deck/open.h"

namespace prismesh::importer {

namespace {

constexpr ipc::LineLimits kRequestLimits{64 << 10, 1};
constexpr double kProgressStep = 0.03;

struct ImportJob {
  ipc::Import request;
  ipc::Descriptor folder;
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
  Result<ipc::Import> request = ipc::decode_import_request(*line);
  if (!request) return fail(std::move(request.error()));
  if (request->protocol != ipc::kImportProtocol)
    return fail("request", "prismesh-import and who asks it are of different versions; use programs of one version");
  Result<std::vector<ipc::Descriptor>> folder = socket.take_descriptors(1);
  if (!folder) return fail(std::move(folder.error()));
  return ImportJob{std::move(*request), std::move(folder->front())};
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

Result<void> fill(const ipc::Descriptor& memory, const mesh::deck::OpenedDeck& opened, const std::string& path,
                  const ipc::ImportLimits& limits) {
  const std::size_t size = ipc::hand_over_size(opened);
  if (size > limits.memory_bytes) return too_large(path, limits);
  if (::ftruncate(memory.get(), static_cast<off_t>(size)) != 0)
    return fail(path, std::string("can't be handed over: ") + std::strerror(errno));
  void* mapped = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, memory.get(), 0);
  if (mapped == MAP_FAILED) return too_large(path, limits);
  ipc::write_hand_over(opened, {static_cast<std::byte*>(mapped), size});
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

/// Reads the deck and fills the memory with it.
Result<void> read(const ImportJob& job, ipc::LineSocket& socket, const ipc::Descriptor& memory) {
  const ipc::ImportLimits& limits = job.request.limits;
  const std::filesystem::path path = std::filesystem::path(job.request.shown_folder) / job.request.main;
  try {
    const ConfinedFiles files(job.folder.get(), job.request.shown_folder);
    const mesh::deck::ReadingLimits reading{limits.files, limits.text_bytes, limits.nodes, limits.elements};
    const Result<mesh::deck::OpenedDeck> opened = mesh::deck::open_within(files, reading, path, told_to(socket));
    if (!opened) return fail(opened.error());
    return fill(memory, *opened, path.string(), limits);
  } catch (const std::bad_alloc&) {
    return too_large(path.string(), limits);
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
  const ipc::ImportLimits& limits = job->request.limits;
  Result<ipc::Descriptor> memory = make_memory(limits.memory_bytes);
  if (!memory) return refuse(memory.error());
  Result<std::vector<std::string>> unguarded =
      lock_in({job->folder.get(), socket.descriptor(), memory->get()}, {limits.memory_bytes, limits.cpu_s});
  if (!unguarded) return refuse(unguarded.error());
  if (const Result<void> done = read(*job, socket, *memory); !done) return refuse(done.error());
  std::vector<ipc::Descriptor> handed;
  handed.push_back(std::move(*memory));
  return send(socket, ipc::Imported{std::move(*unguarded)}, std::move(handed));
}

}  // namespace prismesh::importer
