// The only source that uses libserialport.
#include <libserialport.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <cerrno>
#include <filesystem>

#include "drivers/port/descriptor_port.h"
#include "drivers/port/open_error.h"
#include "drivers/port/open_port.h"

namespace prismesh::drivers::port {

namespace {

class SerialPort final : public BytePort {
 public:
  explicit SerialPort(sp_port* line) : line_(line) { sp_get_port_handle(line_, &descriptor_); }
  ~SerialPort() override {
    sp_close(line_);
    sp_free_port(line_);
  }
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  PortCount read(std::span<std::byte> to) override {
    if (gone_) return {0, PortStatus::gone};
    if (to.empty() || input_is_empty(descriptor_)) return {};
    const int got = sp_nonblocking_read(line_, to.data(), to.size());
    if (got < 0) return failed(errno);
    if (got == 0 && hung_up(descriptor_)) return failed(0);  // libserialport reports the end of file as 0 bytes
    return {static_cast<std::size_t>(got), PortStatus::ok};
  }

  PortCount write(std::span<const std::byte> from) override {
    if (gone_) return {0, PortStatus::gone};
    if (from.empty()) return {};
    const int put = sp_nonblocking_write(line_, from.data(), from.size());
    if (put < 0) return failed(errno);
    const auto bytes = static_cast<std::size_t>(put);
    return {bytes, bytes < from.size() ? PortStatus::full : PortStatus::ok};
  }

  void discard_input() override {
    if (!gone_) sp_flush(line_, SP_BUF_INPUT);
  }
  bool set_baud(int baud) override { return !gone_ && sp_set_baudrate(line_, baud) == SP_OK; }
  int last_error() const override { return last_error_; }

 private:
  PortCount failed(int error) {
    gone_ = true;
    last_error_ = error;
    return {0, PortStatus::gone};
  }

  sp_port* line_;
  int descriptor_ = -1;
  bool gone_ = false;
  int last_error_ = 0;
};

/// Returns the kernel's own name for the device behind `path`, as a file in /dev. libserialport accepts only these names, not links such as
/// /dev/serial/by-id/...
Result<std::string> own_file(const std::string& path) {
  struct stat what {};
  if (::stat(path.c_str(), &what) != 0) return fail(open_error(path, errno));
  const std::string number = std::to_string(major(what.st_rdev)) + ":" + std::to_string(minor(what.st_rdev));
  std::error_code error;
  const std::filesystem::path device = std::filesystem::read_symlink("/sys/dev/char/" + number, error);
  if (!S_ISCHR(what.st_mode) || error) return fail(open_error(path, ENOTTY));
  return "/dev/" + device.filename().string();
}

/// Returns a phrase that says which setting the line refused; null if it accepted all.
const char* set_up(sp_port* line, const SerialSettings& settings) {
  if (sp_set_baudrate(line, settings.baud) != SP_OK) return "can't do this speed";
  if (sp_set_bits(line, 8) != SP_OK || sp_set_parity(line, SP_PARITY_NONE) != SP_OK || sp_set_stopbits(line, 1) != SP_OK)
    return "can't do 8 data bits without parity";
  if (sp_set_flowcontrol(line, SP_FLOWCONTROL_NONE) != SP_OK) return "can't do without flow control";
  return nullptr;
}

}  // namespace

Result<std::unique_ptr<BytePort>> open_serial_port(const std::string& path, const SerialSettings& settings) {
  const Result<std::string> file = own_file(path);
  if (!file) return fail(file.error());
  sp_port* line = nullptr;
  if (sp_get_port_by_name(file->c_str(), &line) != SP_OK)
    return fail(open_error(path, ENOTTY));  // the file exists, but it isn't a serial line
  errno = 0;
  if (const sp_return opened = sp_open(line, SP_MODE_READ_WRITE); opened != SP_OK) {
    const int error = opened == SP_ERR_FAIL && errno != 0 ? errno : ENOTTY;
    sp_free_port(line);
    return fail(open_error(path, error));
  }
  auto port = std::make_unique<SerialPort>(line);
  int descriptor = -1;
  sp_get_port_handle(line, &descriptor);
  if (const int error = lock(descriptor); error != 0) return fail(open_error(path, error));
  if (const int error = refuse_others(descriptor); error != 0) return fail(open_error(path, error));
  if (const char* refused = set_up(line, settings); refused != nullptr)
    return fail(path, std::string(refused) + " (" + std::to_string(settings.baud) + " baud, 8N1)");
  port->discard_input();
  return port;
}

}  // namespace prismesh::drivers::port
