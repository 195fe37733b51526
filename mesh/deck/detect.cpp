#include "mesh/deck/detect.h"

#include <algorithm>

namespace prismesh::mesh::deck {
namespace {

/// Enough to get past any header of comments; a keyword of its own decides earlier, and one that two formats share doesn't decide.
constexpr std::size_t kLookedAt = std::size_t{256} << 10;
constexpr std::size_t kMaxLineLength = 200;
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

std::string upper_line(std::string_view line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t')) line.remove_suffix(1);
  std::string out(line.substr(0, kMaxLineLength));
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

struct Signature {
  std::string_view bytes;
  std::string_view meaning;
};

constexpr Signature kSignatures[] = {
    {std::string_view("PK\x03\x04", 4), "a ZIP archive (or an office document); unpack it first"},
    {std::string_view("\x1f\x8b", 2), "a gzip file that is packed in a way other than gzip's own (deflate); unpack it first"},
    {std::string_view("BZh", 3), "a bzip2 file; unpack it first"},
    {std::string_view("\xfd"
                      "7zXZ",
                      5),
     "an xz file; unpack it first"},
    {std::string_view("\x28\xb5\x2f\xfd", 4), "a zstd file; unpack it first"},
    {std::string_view("7z\xbc\xaf", 4), "a 7-Zip archive; unpack it first"},
    {std::string_view("%PDF", 4), "a PDF document"},
    {std::string_view("\x7f"
                      "ELF",
                      4),
     "a program"},
    {std::string_view("\x89PNG", 4), "a PNG picture"},
    {std::string_view("\xff\xd8\xff", 3), "a JPEG picture"},
    {std::string_view("\x89HDF", 4), "an HDF5 file"},
    {std::string_view("\xff\xfe", 2), "text in UTF-16; save it as plain text first"},
    {std::string_view("\xfe\xff", 2), "text in UTF-16; save it as plain text first"},
    {std::string_view("ISO-10303-21", 12), "a STEP file (CAD geometry)"},
    {std::string_view("<?xml", 5), "an XML file"},
    {std::string_view("-----BEGIN PGP", 14), "a file that is encrypted as a whole"},
};

/// Evidence for each format.
struct Votes {
  int ls_dyna = 0;
  int nastran = 0;
  int radioss = 0;
  int abaqus = 0;
  int abaqus_comments = 0;    ///< lines that begin with two asterisks; other texts have such lines as well
  bool has_keywords = false;  ///< a line that begins with an asterisk and a word

  int max() const { return std::max({ls_dyna, nastran, radioss, abaqus}); }
};

constexpr int kCertain = 1000;
constexpr int kDecides = 20;  ///< a keyword that one format alone has

bool is_word(std::string_view line, std::string_view word) {
  return line.starts_with(word) &&
         (line.size() == word.size() || std::string_view(" *,\t0123456789").find(line[word.size()]) != std::string_view::npos);
}

void vote_on_asterisk(std::string_view line, Votes& votes) {
  if (line.starts_with("**")) {
    ++votes.abaqus_comments;
    return;
  }
  const std::string_view name = line.substr(1, line.find_first_of(" ,=\t") - 1);
  // In other texts an asterisk begins an item of a list or emphasised words, and another one ends these.
  votes.has_keywords |= !name.empty() && name[0] >= 'A' && name[0] <= 'Z' && line.find('*', 1) == std::string_view::npos;
  if (name.starts_with("KEYWORD")) votes.ls_dyna += kCertain;
  for (const std::string_view own : {"HEADING", "STEP", "PREPRINT", "INSTANCE", "ASSEMBLY", "ELSET", "NSET", "SHELL", "MATERIAL", "SOLID"})
    if (name == own) votes.abaqus += kDecides;
  // Abaqus keywords take parameters with an equals sign and have blanks, those of LS-DYNA have underscores.
  if (line.find(',') != std::string_view::npos && line.find('=') != std::string_view::npos) votes.abaqus += kDecides;
  for (const std::string_view own :
       {"ELEMENT_",  "SECTION_", "MAT_",  "PART",     "CONTROL_", "PARAMETER", "INCLUDE",      "SET_", "DEFINE_",   "DATABASE_",
        "BOUNDARY_", "CONTACT_", "LOAD_", "INITIAL_", "NODE",     "TITLE",     "CONSTRAINED_", "EOS_", "HOURGLASS", "END"})
    if (name.starts_with(own)) votes.ls_dyna += name.find('_') != std::string_view::npos ? kDecides : 2;
}

void vote_on_slash(std::string_view line, Votes& votes) {
  for (const std::string_view own : {"/BEGIN", "/NODE", "/SHELL/", "/SH3N/", "/PART/", "/PROP/", "/MAT/", "/TITLE", "/BRICK/", "/GRNOD/"})
    if (line.starts_with(own)) votes.radioss += kDecides;
  // Input of the Radioss engine, which the reader refuses by name.
  for (const std::string_view engine : {"/RUN/", "/VERS/", "/TFILE", "/RFILE", "/ANIM/", "/H3D/", "/STOP", "/PRINT/", "/MON/"})
    if (line.starts_with(engine)) votes.radioss += kDecides;
}

void vote_on_word(std::string_view line, Votes& votes) {
  if (line.starts_with("BEGIN BULK") || is_word(line, "CEND")) votes.nastran += kCertain;
  if (line.starts_with("NASTRAN ") || line.starts_with("SOL ")) votes.nastran += kDecides;
  for (const std::string_view card :
       {"GRID", "CQUAD4", "CTRIA3", "CQUAD1", "CHEXA", "CBAR", "CBEAM", "PSHELL", "PCOMP", "MAT1", "RBE2", "SPC1", "ENDDATA", "INCLUDE"})
    if (is_word(line, card)) votes.nastran += 10;
}

void count_votes(std::string_view text, Votes& votes) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string line = upper_line(text.substr(0, std::min(end, kMaxLineLength)));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.empty()) continue;
    if (line.starts_with("#RADIOSS")) votes.radioss += kCertain;
    if (line[0] == '*')
      vote_on_asterisk(line, votes);
    else if (line[0] == '/')
      vote_on_slash(line, votes);
    else if (line[0] != '$' && line[0] != '#')
      vote_on_word(line, votes);
    if (votes.max() >= kCertain) break;
  }
}

/// Meshes begin with *NODE in two formats, and a large one has nothing else for long: looks at lines with an asterisk only, up to the first
/// that decides.
void look_for_a_deciding_keyword(std::string_view text, Votes& votes) {
  for (std::size_t at = text.find("\n*"); at != std::string_view::npos && votes.max() < kDecides; at = text.find("\n*", at + 1)) {
    const std::string_view line = text.substr(at + 1, kMaxLineLength);
    vote_on_asterisk(upper_line(line.substr(0, line.find('\n'))), votes);
  }
}

/// Whether lines end with carriage returns alone, as of old Macintosh computers and broken transfers: the text would be one line.
bool has_carriage_returns_alone(std::string_view text) {
  return text.find('\n') == std::string_view::npos && std::count(text.begin(), text.end(), '\r') > 1;
}

std::string describe(std::string_view text) {
  if (text.starts_with("solid ")) return "an STL file";
  const auto binary = std::count_if(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) < 32 && c != '\n' && c != '\r' && c != '\t' && c != '\f';
  });
  if (static_cast<std::size_t>(binary) * 50 > text.size()) return "a binary file";
  if (text.find('\0') != std::string_view::npos) return "a text with NUL bytes in it, as a broken transfer leaves them";
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) return "an empty file";
  return "text without a single keyword of a deck";
}

}  // namespace

Detected detect_format(std::string_view text) {
  if (text.empty()) return {{}, "an empty file"};
  for (const Signature& signature : kSignatures)
    if (text.starts_with(signature.bytes)) return {{}, std::string(signature.meaning)};
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  const std::string_view rest = text.size() > kLookedAt ? text.substr(kLookedAt) : std::string_view();
  text = text.substr(0, kLookedAt);
  if (has_carriage_returns_alone(text))
    return {{}, "text whose lines end with carriage returns alone; save it with LF or CRLF line ends first"};
  Votes votes;
  count_votes(text, votes);
  if (votes.has_keywords && votes.max() < kDecides) look_for_a_deciding_keyword(rest, votes);
  if (votes.has_keywords) votes.abaqus += votes.abaqus_comments;
  const int most = votes.max();
  if (most == 0 || (most < kCertain && text.find('\0') != std::string_view::npos)) return {{}, describe(text)};
  if (votes.ls_dyna == most) return {Format::ls_dyna, {}};
  if (votes.nastran == most) return {Format::nastran, {}};
  if (votes.radioss == most) return {Format::radioss, {}};
  return {Format::abaqus, {}};
}

}  // namespace prismesh::mesh::deck
