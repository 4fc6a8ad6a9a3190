#include "wingbeat/reproduction/reproduce.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>
#include <set>

#include "reproduction/embedded.hpp"
#include "reproduction/sheet.hpp"
#include "wingbeat/files/design_file.hpp"
#include "wingbeat/files/output_file.hpp"
#include "wingbeat/files/stored_file.hpp"
#include "wingbeat/files/units.hpp"

namespace wingbeat {
namespace fs = std::filesystem;
namespace {

constexpr const char* notice = "README.txt";

std::string first_line(std::string_view paper) { return fmt::format("Written by: wingbeat reproduce {}\n", paper); }

PublishedFile friction2022() {
  return parse_published(embedded::text_of("published/friction2022.toml"), "data/published/friction2022.toml",
                         [](const std::string& file) {
                           const std::string name = fs::path("published" / fs::path(file)).lexically_normal().string();
                           return parse_design(embedded::text_of(name), "data/" + name);
                         });
}

constexpr KnownPaper papers[] = {{"friction2022", friction2022}};

/// cairo writes the time of day into a PDF: the only bytes that would differ between two runs.
void remove_date(const fs::path& file) {
  std::string text = read_text_file(file);
  const std::string key = "/CreationDate (D:";
  const auto position = text.find(key);
  if (position == std::string::npos) return;
  for (std::size_t n = 0; n < 14 && position + key.size() + n < text.size(); ++n)
    text[position + key.size() + n] = "20220101000000"[n];
  store(file, text);
}

SpringPair pair_of(const PublishedFile& file) {
  const auto design = [&](const char* name) {
    const auto found = file.designs.find(name);
    if (found == file.designs.end()) throw std::runtime_error(fmt::format("the published file has no design {}", name));
    return found->second;
  };
  return {design("spring_off"), design("spring_on")};
}

}  // namespace

std::span<const KnownPaper> known_papers() { return papers; }

const KnownPaper& known_paper(std::string_view name) {
  std::string names;
  for (const KnownPaper& paper : papers) {
    if (paper.name == name) return paper;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", paper.name);
  }
  throw InputError(fmt::format("reproduce {}", one_line(name)), 0, 0, "",
                   fmt::format("the program knows no such paper; it knows {}", names));
}

namespace {

/// The name a file of a reproduction has.
bool is_piece(const std::string& name) {
  const std::string_view begins[] = {"figure-",      "friction-laws.", "friction-law-deviations.",
                                     "energy-flow",  "scorecard.",     "further-physics.",
                                     "power-cycle-", "claims.",        "report.html"};
  return name == notice ||
         std::any_of(std::begin(begins), std::end(begins), [&](auto b) { return name.starts_with(b); });
}

std::string listed(const std::string& name, std::string_view content) {
  boost::crc_32_type sum;
  sum.process_bytes(content.data(), content.size());
  return fmt::format("{:08x} {}\n", sum.checksum(), name);
}

/// The lines of the notice that list files: check sum and name.
std::set<std::string> listed_in(const fs::path& folder) {
  std::set<std::string> lines;
  std::ifstream in(folder / notice);
  for (std::string line; std::getline(in, line);) {
    if (line.size() > 9 && line.find_first_not_of("0123456789abcdef") == 8 && line[8] == ' ') lines.insert(line + "\n");
  }
  return lines;
}

/// True of a folder that a version without check sums wrote: all of its pieces count as the program's.
bool is_without_sums(const fs::path& folder, std::string_view paper) {
  std::ifstream in(folder / notice, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return text.starts_with(first_line(paper)) && text.find("\nCheck sums") == std::string::npos;
}

/// True if the file is as an earlier run left it.
bool is_listed(const fs::path& file, const std::set<std::string>& lines) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return false;
  std::ifstream in(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(in), {}};
  return lines.contains(listed(file.filename().string(), content));
}

/// Refuses to replace a piece that the program did not write or that was changed since.
void check_pieces(const fs::path& folder, bool force) {
  const std::set<std::string> lines = listed_in(folder);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (!is_piece(entry.path().filename().string())) continue;
    checked_output("-o", entry.path(), {"", force || is_listed(entry.path(), lines)});
  }
}

}  // namespace

void prepare_reproduction_folder(const fs::path& folder, std::string_view paper, bool force) {
  const auto refuse = [&](const std::string& reason) {
    throw InputError(fmt::format("-o {}", folder.string()), 0, 0, "", reason);
  };
  std::error_code error;
  const auto status = fs::status(folder, error);
  if (fs::exists(status)) {
    if (!fs::is_directory(status)) refuse("is a file, not a folder");
    const bool empty = fs::is_empty(folder, error);
    if (error) refuse(fmt::format("cannot be read: {}", error.message()));
    if (!empty) {
      std::string begins;
      if (std::FILE* in = std::fopen((folder / notice).c_str(), "rb")) {
        char line[200];
        if (std::fgets(line, sizeof line, in)) begins = line;
        std::fclose(in);
      }
      if (begins == first_line(paper)) {
        check_pieces(folder, force || is_without_sums(folder, paper));
      } else if (force) {
        check_pieces(folder, true);
      } else {
        refuse("holds files of something else; name a new or an empty folder, or --force to write among them");
      }
    }
  } else {
    const fs::path parent = fs::absolute(folder, error).lexically_normal().parent_path();
    if (!fs::is_directory(parent, error)) refuse(fmt::format("there is no folder {}", parent.string()));
    if (!fs::create_directory(folder, error)) refuse(fmt::format("cannot be made: {}", error.message()));
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) refuse(fmt::format("cannot be written: {}", std::strerror(errno)));
}

ReproduceResult reproduce_paper(const KnownPaper& paper, const ReproduceOptions& options) {
  using namespace reproduction;
  require_gnuplot();
  fs::path folder = options.output;
  prepare_reproduction_folder(folder, paper.name, options.force);
  const std::set<std::string> known = listed_in(folder);
  const bool replace = options.force || is_without_sums(folder, paper.name);
  const auto put = [&](const std::string& name, std::string_view content) {
    OutputFile file("-o", folder / name, {"", replace || is_listed(folder / name, known)});
    file.write(content);
    file.commit();
  };
  const std::string about =
      first_line(paper.name) +
      "Open report.html. figure-*: each figure as SVG and PDF, its data as CSV and NetCDF (.nc).\n"
      "claims.csv, claims.json: every statement assessed. Running the command again replaces these files.\n"
      "\nCheck sums (CRC-32) of the texts, by which the command knows them again:\n";
  // Beside what will be written now stands what an earlier run wrote: one that is interrupted leaves either.
  std::set<std::string> lines = known;
  const auto write_notice = [&] {
    put(notice, about + fmt::format("{}", fmt::join(lines, "")));
    FileRecord::of_this_program().withdraw(fs::canonical(folder) / notice);
  };
  write_notice();
  const auto progress = [&](double share, const std::string& what) {
    if (options.progress) options.progress(share, what);
  };

  ReproduceResult result;
  result.file = paper.published();
  const SpringPair pair = pair_of(result.file);
  progress(0.0, "computing");
  ReproductionOptions computing;
  computing.coarse = options.coarse;
  const Reproduction computed =
      reproduce(pair, computing, options.for_each, [&](double share) { progress(0.2 * share, "computing"); });
  result.assessment =
      assess(result.file, options.for_each, [&](double share) { progress(0.2 + 0.1 * share, "assessing statements"); });

  const std::vector<FurtherVariant> further = further_physics(pair, computing, options.for_each);
  const Material material{result.file, pair, computed, result.assessment, further};
  std::vector<Sheet> sheets = summary_sheets(material);
  for (const auto& more : {mechanism_sheets(material), paper_sheets(material), section5_sheets(material),
                           friction_sheets(material), further_sheets(material), energy_sheets(material)}) {
    sheets.insert(sheets.end(), more.begin(), more.end());
  }
  result.figures = int(sheets.size());
  Provenance provenance;
  provenance.command = "reproduce";
  provenance.version = options.version;
  provenance.vehicle = write_design(pair[1]);
  provenance.condition = "air";
  provenance.method = "orbit";
  provenance.tolerance = 1e-7;

  std::mutex mutex;
  std::size_t finished = 0;
  std::vector<std::string> drawings(sheets.size());
  // One thread for each drawing: gnuplot is a process of its own. NetCDF is not for several threads.
  options.for_each(sheets.size(), [&](std::size_t n) {
    const Sheet& s = sheets[n];
    for (const auto& [format, extension] : {std::pair(PlotFormat::svg, ".svg"), std::pair(PlotFormat::pdf, ".pdf")}) {
      OutputFile file("-o", folder / (s.id + extension), {"", replace});
      s.draw(format, file.temporary());
      if (format == PlotFormat::pdf) remove_date(file.temporary());
      else drawings[n] = read_text_file(file.temporary());
      file.commit();
    }
    const std::lock_guard<std::mutex> lock(mutex);
    progress(0.3 + 0.68 * double(++finished) / double(sheets.size()), "drawing");
  });
  std::vector<std::pair<std::string, std::string>> texts = {
      {"claims.csv", csv_claims(result.assessment)},
      {"claims.json", json_claims(result.file, result.assessment)},
      {"report.html", report_html(material, sheets, options.version,
                                  [&](const Sheet& s) { return drawings[std::size_t(&s - sheets.data())]; })}};
  for (const Sheet& s : sheets) texts.emplace_back(s.id + ".csv", csv(s.table));
  for (const auto& [name, content] : texts) lines.insert(listed(name, content));
  write_notice();
  for (const auto& [name, content] : texts) put(name, content);
  lines.clear();
  for (const auto& [name, content] : texts) lines.insert(listed(name, content));
  write_notice();
  for (const Sheet& s : sheets) {
    OutputFile data("-o", folder / (s.id + ".nc"), {"", replace});
    provenance.title = s.heading;
    write_netcdf(s.table, provenance, data.temporary());
    data.commit();
    if (!s.animation.empty()) put(s.id + "-moving.svg", s.animation);
  }
  progress(1.0, "done");
  return result;
}

}  // namespace wingbeat
