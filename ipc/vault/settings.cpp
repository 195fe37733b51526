#include "ipc/vault/settings.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include <sys/stat.h>
#include <toml++/toml.h>

#include "base/nearest_name.h"
#include "ipc/store/folder.h"

namespace prismesh::ipc::vault {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxSettings = std::size_t{64} << 10;
constexpr std::size_t kMaxValue = 2000;
constexpr std::size_t kMaxSession = 8192;
constexpr std::array<std::string_view, 4> kKeys{"access_key_id", "region", "secret_access_key", "vault"};

/// What can stand in a header and a signature.
bool is_header_text(std::string_view text, std::size_t max_bytes = kMaxValue) {
  return !text.empty() && text.size() <= max_bytes && std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

std::optional<std::string> environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != 0 ? std::optional<std::string>(value) : std::nullopt;
}

std::optional<fs::path> usual_settings() {
  if (const auto config = environment("XDG_CONFIG_HOME"); config && config->front() == '/')
    return fs::path(*config) / "prismesh/vault.toml";
  if (const auto home = environment("HOME"); home && home->front() == '/') return fs::path(*home) / ".config/prismesh/vault.toml";
  return std::nullopt;
}

Result<VaultSettings> read_settings_file(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const Result<store::Folder> opened = store::Folder::open(folder);
  if (!opened) return fail(opened.error());
  const Result<Descriptor> file = opened->read(path.filename().string());
  if (!file) return fail(file.error());
  struct stat status {};
  if (::fstat(file->get(), &status) != 0) return fail(path.string(), "can't be read");
  if ((status.st_mode & 0077) != 0)
    return fail(path.string(),
                "others may read the keys in it; make it private (chmod 600), and have new keys made if somebody may have read it");
  std::string text(kMaxSettings + 1, '\0');
  const Result<std::size_t> got = store::read_at(*file, text.data(), text.size(), 0, path);
  if (!got) return fail(got.error());
  if (*got > kMaxSettings) return fail(path.string(), "is longer than " + std::to_string(kMaxSettings) + " bytes");
  return parse_vault_settings(std::string_view(text).substr(0, *got), path.string());
}

}  // namespace

Result<VaultSettings> parse_vault_settings(std::string_view text, const std::string& file) {
  toml::table table;
  try {
    table = toml::parse(text, file);
  } catch (const toml::parse_error& problem) {
    // Its own words may quote a value.
    return fail(file, static_cast<long>(problem.source().begin.line), "can't be read as TOML; write lines like region = \"us-east-1\"");
  }
  VaultSettings settings;
  for (const auto& [key, node] : table) {
    const long line = static_cast<long>(node.source().begin.line);
    const std::string name(key.str());
    if (std::find(kKeys.begin(), kKeys.end(), name) == kKeys.end())
      return fail(file, line, "a vault has no such setting; the nearest is \"" + std::string(nearest_name(name, kKeys)) + "\"");
    const auto value = node.value_exact<std::string>();
    if (!value || !is_header_text(*value)) return fail(file, line, name + " must be a text in quotes, without blanks");
    if (name == "vault") settings.vault = *value;
    if (name == "region") settings.region = *value;
    if (name == "access_key_id") settings.access_key_id = *value;
    if (name == "secret_access_key") settings.secret_access_key = *value;
  }
  return settings;
}

Result<VaultSettings> read_vault_settings(const std::optional<fs::path>& given) {
  VaultSettings settings;
  std::error_code ignored;
  const std::optional<fs::path> usual = usual_settings();
  if (given || (usual && fs::exists(*usual, ignored))) {
    Result<VaultSettings> read = read_settings_file(given ? *given : *usual);
    if (!read) return read;
    settings = std::move(*read);
  }
  if (auto vault = environment("PRISMESH_VAULT")) settings.vault = std::move(*vault);
  auto region = environment("AWS_REGION");
  if (!region) region = environment("AWS_DEFAULT_REGION");
  if (region) settings.region = std::move(*region);
  if (auto key = environment("AWS_ACCESS_KEY_ID")) settings.access_key_id = std::move(*key);
  if (auto secret = environment("AWS_SECRET_ACCESS_KEY")) {
    settings.secret_access_key = std::move(*secret);
    settings.session_token = environment("AWS_SESSION_TOKEN").value_or("");
  }
  if (auto authorities = environment("AWS_CA_BUNDLE")) settings.authorities = std::move(*authorities);
  const std::string where = usual ? ", or access_key_id and secret_access_key in " + usual->string() : "";
  if (settings.access_key_id.empty() || settings.secret_access_key.empty())
    return fail("", "there are no keys for the vault; set AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY" + where);
  for (const std::string* value : {&settings.access_key_id, &settings.secret_access_key, &settings.region})
    if (!is_header_text(*value)) return fail("", "keys and region of a vault can't have blanks or signs beyond ASCII");
  if (!settings.session_token.empty() && !is_header_text(settings.session_token, kMaxSession))
    return fail("", "AWS_SESSION_TOKEN can't have blanks, signs beyond ASCII, or more than " + std::to_string(kMaxSession) + " bytes");
  return settings;
}

}  // namespace prismesh::ipc::vault
