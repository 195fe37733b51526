#include "mesh/deck/sample.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "base/file.h"
#include "mesh/deck/sample/body_side.h"

namespace prismesh::mesh::deck {
namespace {

/// Each part's ids start at a round number, with room for the largest sample.
constexpr std::int64_t kIdsPerPart = 5'000'000;
constexpr std::int64_t kWeldPart = 90;

/// Appends fields of fixed width; numbers are aligned right.
class Cards {
 public:
  void reserve(std::size_t bytes) { text_.reserve(bytes); }
  Cards& line(std::string_view words) {
    text_.append(words).push_back('\n');
    return *this;
  }
  Cards& integer(std::int64_t value, std::size_t width = 10) {
    std::array<char, 24> digits;
    std::size_t used = 0;
    for (std::int64_t rest = value; rest != 0 || used == 0; rest /= 10) digits[used++] = static_cast<char>('0' + rest % 10);
    pad(width, used);
    while (used > 0) text_.push_back(digits[--used]);
    return *this;
  }
  /// A coordinate with six decimals in 16 columns. Rounded here, so that the text doesn't depend on a formatting library.
  Cards& coordinate(double value) {
    const auto millionths = static_cast<std::int64_t>(std::floor(std::abs(value) * 1e6 + 0.5));
    const bool negative = value < 0 && millionths != 0;
    const std::size_t at = text_.size();
    text_.append(16, ' ');
    std::int64_t rest = millionths;
    std::size_t column = at + 16;
    for (int decimals = 0; decimals < 6; ++decimals, rest /= 10) text_[--column] = static_cast<char>('0' + rest % 10);
    text_[--column] = '.';
    do {
      text_[--column] = static_cast<char>('0' + rest % 10);
      rest /= 10;
    } while (rest != 0);
    if (negative) text_[--column] = '-';
    return *this;
  }
  /// A number that is text already, aligned right.
  Cards& number(std::string_view text, std::size_t width = 10) {
    pad(width, text.size());
    text_.append(text);
    return *this;
  }
  Cards& end() {
    text_.push_back('\n');
    return *this;
  }
  std::string take() { return std::move(text_); }

 private:
  void pad(std::size_t width, std::size_t used) { text_.append(width > used ? width - used : 0, ' '); }
  std::string text_;
};

/// A thickness in tenths of a millimetre, as text.
std::string tenths(double thickness) {
  const long value = std::lround(thickness * 10);
  return std::to_string(value / 10) + "." + std::to_string(value % 10);
}

std::size_t count_all(const sample::ElementSize& size) {
  std::size_t count = 0;
  for (const sample::Part& part : sample::body_side(size.across).parts) count += sample::count_shells(part, size);
  return count;
}

/// The element size whose mesh has nearly the wanted number of shells. The count follows size^-2, but jumps where all flanges get another
/// row; the edge length along the parts makes up for the rest.
sample::ElementSize size_for(std::size_t shells) {
  const auto ratio = [&](const sample::ElementSize& size) { return static_cast<double>(count_all(size)) / static_cast<double>(shells); };
  double guess = 16;
  for (int step = 0; step < 3; ++step) guess *= std::sqrt(ratio({guess, guess}));
  sample::ElementSize best{guess, guess};
  double best_error = std::abs(ratio(best) - 1);
  const auto try_size = [&](const sample::ElementSize& size) {
    const double error = std::abs(ratio(size) - 1);
    if (error >= best_error) return;
    best_error = error;
    best = size;
  };
  constexpr double kNearEnough = 0.003;
  for (int attempt = 1; attempt <= 20 && best_error > kNearEnough; ++attempt) {
    const double size = guess * (1 + 0.0025 * (attempt % 2 == 0 ? attempt : -attempt));
    try_size({size, size});
  }
  if (best_error > kNearEnough) try_size({best.across, best.across * ratio(best)});
  return best;
}

void write_control(Cards& cards) {
  cards.line("*KEYWORD")
      .line("*TITLE")
      .line("Front rail, sill, pillar and floor: a sheet-metal sample (mm, t, s)")
      .line("*CONTROL_TERMINATION")
      .line("$#  endtim    endcyc     dtmin    endeng    endmas")
      .line("      0.06")
      .line("*CONTROL_TIMESTEP")
      .line("$#  dtinit    tssfac      isdo    tslimt     dt2ms")
      .line("       0.0       0.9         0       0.0       0.0")
      .line("*DATABASE_BINARY_D3PLOT")
      .line("$#      dt")
      .line("     0.001")
      .line("*CONTACT_AUTOMATIC_SINGLE_SURFACE_ID")
      .line("$#     cid                                                                 title")
      .line("         1All sheets")
      .line("$#    ssid      msid     sstyp     mstyp    sboxid    mboxid       spr       mpr")
      .line("         1         0         2         0         0         0         0         0")
      .line("$#      fs        fd        dc        vc       vdc    penchk        bt        dt")
      .line("       0.2       0.2       0.0       0.0      20.0         0       0.0       0.0")
      .line("$#     sfs       sfm       sst       mst      sfst      sfmt       fsf       vsf")
      .line("       1.0       1.0       0.0       0.0       1.0       1.0       1.0       1.0")
      .line("*CONTACT_SPOTWELD_ID")
      .line("$#     cid                                                                 title")
      .line("         2Spot welds")
      .line("$#    ssid      msid     sstyp     mstyp    sboxid    mboxid       spr       mpr")
      .line("         2         1         2         2         0         0         0         0")
      .line("$#      fs        fd        dc        vc       vdc    penchk        bt        dt")
      .line("       0.0       0.0       0.0       0.0       0.0         0       0.0       0.0")
      .line("$#     sfs       sfm       sst       mst      sfst      sfmt       fsf       vsf")
      .line("       1.0       1.0       0.0       0.0       1.0       1.0       1.0       1.0");
}

void write_parts(Cards& cards, const sample::Assembly& assembly) {
  for (const sample::Part& part : assembly.parts) {
    cards.line("*PART").line(part.title).line("$#     pid     secid       mid     eosid      hgid      grav    adpopt      tmid");
    cards.integer(part.id).integer(part.id).integer(part.thickness < 1.5 ? 1 : 2);
    for (int field = 0; field < 5; ++field) cards.integer(0);
    cards.end().line("*SECTION_SHELL_TITLE").line(part.title);
    cards.line("$#   secid    elform      shrf       nip     propt   qr/irid     icomp     setyp");
    cards.integer(part.id).integer(16).number("0.8333").integer(5).integer(1).integer(0).integer(0).integer(1).end();
    cards.line("$#      t1        t2        t3        t4      nloc     marea      idof    edgset");
    const std::string thickness = tenths(part.thickness);
    for (int corner = 0; corner < 4; ++corner) cards.number(thickness);
    cards.number("0.0").number("0.0").number("0.0").integer(0).end();
  }
  cards.line("*PART").line("Spot welds").line("$#     pid     secid       mid     eosid      hgid      grav    adpopt      tmid");
  cards.integer(kWeldPart).integer(kWeldPart).integer(3);
  for (int field = 0; field < 5; ++field) cards.integer(0);
  cards.end()
      .line("*SECTION_BEAM_TITLE")
      .line("Spot welds")
      .line("$#   secid    elform      shrf   qr/irid       cst     scoor       nsm")
      .line("        90         9       1.0         2         1       0.0       0.0")
      .line("$#     ts1       ts2       tt1       tt2     nsloc     ntloc")
      .line("       6.0       6.0       0.0       0.0       0.0       0.0");
}

void write_materials(Cards& cards) {
  const auto steel = [&](std::string_view title, int id, std::string_view yield, std::string_view tangent) {
    cards.line("*MAT_PIECEWISE_LINEAR_PLASTICITY_TITLE").line(title);
    cards.line("$#     mid        ro         e        pr      sigy      etan      fail      tdel");
    cards.integer(id).number("7.85e-9").number("210000.0").number("0.3").number(yield).number(tangent).number("1.0e21").number("0.0").end();
    cards.line("$#       c         p      lcss      lcsr        vp").line("       0.0       0.0         0         0       0.0");
    cards.line("$#    eps1      eps2      eps3      eps4      eps5      eps6      eps7      eps8");
    cards.line("       0.0       0.0       0.0       0.0       0.0       0.0       0.0       0.0");
    cards.line("$#     es1       es2       es3       es4       es5       es6       es7       es8");
    cards.line("       0.0       0.0       0.0       0.0       0.0       0.0       0.0       0.0");
  };
  steel("Mild steel", 1, "180.0", "900.0");
  steel("High-strength steel", 2, "420.0", "1200.0");
  cards.line("*MAT_SPOTWELD_TITLE")
      .line("Weld nugget")
      .line("$#     mid        ro         e        pr      sigy        eh        dt     tfail")
      .line("         3   7.85e-9  210000.0       0.3     600.0    1000.0       0.0       0.0")
      .line("$#   efail       nrr       nrs       nrt       mrr       mss       mtt        nf")
      .line("      0.15       0.0       0.0       0.0       0.0       0.0       0.0       0.0");
}

/// Ids in rows of eight.
void write_id_rows(Cards& cards, const std::vector<std::int64_t>& ids) {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    cards.integer(ids[i]);
    if (i % 8 == 7 || i + 1 == ids.size()) cards.end();
  }
}

void write_sets(Cards& cards, const sample::Assembly& assembly, const std::vector<std::int64_t>& clamped) {
  std::vector<std::int64_t> sheets;
  for (const sample::Part& part : assembly.parts) sheets.push_back(part.id);
  cards.line("*SET_PART_LIST_TITLE").line("Sheets").line("$#     sid").line("         1");
  write_id_rows(cards, sheets);
  cards.line("*SET_PART_LIST_TITLE").line("Spot welds").line("$#     sid").line("         2");
  write_id_rows(cards, {kWeldPart});
  cards.line("*SET_NODE_LIST_TITLE").line("Clamped rear end").line("$#     sid").line("         1");
  write_id_rows(cards, clamped);
  cards.line("*BOUNDARY_SPC_SET")
      .line("$#    nsid       cid      dofx      dofy      dofz     dofrx     dofry     dofrz")
      .line("         1         0         1         1         1         1         1         1")
      .line("*RIGIDWALL_PLANAR_MOVING")
      .line("$#    nsid    nsidex     boxid    offset     birth     death     rwksf")
      .line("         0         0         0       0.0       0.0    1.0e20       1.0")
      .line("$#      xt        yt        zt        xh        yh        zh      fric      wvel")
      .line("     -20.0       0.0     150.0       1.0       0.0     150.0       0.3       0.0")
      .line("$#    mass        v0")
      .line("      0.12   13000.0");
}

void write_node(Cards& cards, std::int64_t id, const Vec3& at) {
  cards.integer(id, 8).coordinate(at.x()).coordinate(at.y()).coordinate(at.z()).integer(0, 8).integer(0, 8).end();
}

void write_sheet(Cards& cards, const sample::Part& part, const sample::SheetMesh& mesh, std::int64_t first) {
  cards.line("*NODE").line("$#   nid               x               y               z      tc      rc");
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) write_node(cards, first + static_cast<std::int64_t>(i), mesh.nodes[i]);
  cards.line("*ELEMENT_SHELL").line("$#   eid     pid      n1      n2      n3      n4");
  for (std::size_t i = 0; i < mesh.shells.size(); ++i) {
    cards.integer(first + static_cast<std::int64_t>(i), 8).integer(part.id, 8);
    for (const std::uint32_t node : mesh.shells[i]) cards.integer(first + node, 8);
    cards.end();
  }
}

void write_welds(Cards& cards, const std::vector<sample::SpotWeld>& welds, std::int64_t first) {
  cards.line("*NODE").line("$#   nid               x               y               z      tc      rc");
  for (std::size_t i = 0; i < welds.size(); ++i) {
    write_node(cards, first + 2 * static_cast<std::int64_t>(i), welds[i].from);
    write_node(cards, first + 2 * static_cast<std::int64_t>(i) + 1, welds[i].to);
  }
  cards.line("*ELEMENT_BEAM").line("$#   eid     pid      n1      n2      n3     rt1     rr1     rt2     rr2   local");
  for (std::size_t i = 0; i < welds.size(); ++i) {
    const auto weld = static_cast<std::int64_t>(i);
    cards.integer(first + weld, 8).integer(kWeldPart, 8).integer(first + 2 * weld, 8).integer(first + 2 * weld + 1, 8);
    for (int field = 0; field < 5; ++field) cards.integer(0, 8);
    cards.integer(2, 8).end();
  }
}

Result<std::string> make_text(std::size_t shells, const Progress& progress) {
  const sample::ElementSize size = size_for(shells);
  const sample::Assembly assembly = sample::body_side(size.across);
  Cards cards;
  cards.reserve(shells * 130 + 200'000);
  write_control(cards);
  write_parts(cards, assembly);
  write_materials(cards);
  std::vector<std::int64_t> clamped;
  std::int64_t first = kIdsPerPart + 1;
  for (std::size_t p = 0; p < assembly.parts.size(); ++p) {
    if (progress && !progress(static_cast<double>(p) / static_cast<double>(assembly.parts.size()))) return fail(cancelled());
    const sample::Part& part = assembly.parts[p];
    const sample::SheetMesh mesh = sample::mesh_part(part, size);
    write_sheet(cards, part, mesh, first);
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
      if (mesh.nodes[i].x() > 1640 - 0.5 * size.along) clamped.push_back(first + static_cast<std::int64_t>(i));
    first += kIdsPerPart;
  }
  write_welds(cards, assembly.welds, 90'000'001);
  write_sets(cards, assembly, clamped);
  cards.line("*END");
  return cards.take();
}

}  // namespace

std::string sample_text(std::size_t shells) { return *make_text(shells, {}); }

Result<void> write_sample(const std::filesystem::path& path, std::size_t shells, const Progress& progress) {
  if (shells < kSampleShellsMin || shells > kSampleShellsMax)
    return fail(path.string(), "a sample has " + std::to_string(kSampleShellsMin) + " to " + std::to_string(kSampleShellsMax) +
                                   " shells, not " + std::to_string(shells));
  const Result<std::string> text = make_text(shells, progress);
  const auto at_path = [&](Error error) {
    error.file = path.string();
    return fail(std::move(error));
  };
  if (!text) return at_path(text.error());
  if (progress && !progress(1)) return at_path(cancelled());
  const PendingFile file{path, {*text}};
  return replace_files(std::span(&file, 1));
}

}  // namespace prismesh::mesh::deck
