#include "cli/name_text.h"

#include <charconv>

#include "cli/chart_list.h"
#include "cli/table.h"
#include "cli/text.h"

namespace ramcdb::cli {
namespace {

constexpr std::int64_t kMostSeconds = 3650LL * 24 * 3600;

std::string nameless_text(const std::vector<VersionId>& versions) {
  if (versions.empty()) return "";
  std::string list;
  for (std::size_t i = 0; i < versions.size() && i < 10; ++i) list += (i ? ", " : "") + version_text(versions[i]);
  if (versions.size() > 10) list += ", ...";
  return "no name leads to " + counted(versions.size(), "version") + " any more (" + list +
         "): `ramcdb branch REPO NAME " + version_text(versions.back()) + "` gives one\n";
}

std::string charts_cell(const LockInfo& lock) {
  const std::string charts = chart_list(lock.charts);
  return lock.gone.empty() ? charts : charts + " (gone: " + chart_list(lock.gone) + ")";
}

}  // namespace

std::string name_change_text(const NameChange& change) {
  std::string text = change.kind + " ";
  if (!change.before.empty())
    text += change.before + " is called " + change.name + " now";
  else if (change.version)
    text += change.name + " is at " + version_text(change.version);
  else
    text += change.name + " deleted";
  return text + "\n" + nameless_text(change.nameless);
}

std::string ref_text(const std::vector<RefName>& refs) {
  if (refs.empty()) return "";
  std::string text;
  for (const RefName& ref : refs)
    text += (text.empty() ? " (" : ", ") + std::string(ref.is_tag ? "tag: " : "") + ref.name;
  return text + ")";
}

std::string locks_text(const std::vector<LockInfo>& locks) {
  if (locks.empty()) return "";
  Table table({{"lock"},
               {"owner", Table::Align::left},
               {"until (UTC)", Table::Align::left},
               {"branch", Table::Align::left},
               {"mesh", Table::Align::left},
               {"charts", Table::Align::left},
               {"why", Table::Align::left}});
  for (const LockInfo& lock : locks)
    table.add({std::to_string(lock.id), one_line(lock.owner), iso_time(lock.expires_us, false), one_line(lock.branch),
               one_line(lock.mesh), charts_cell(lock), one_line(lock.reason)});
  return table.text();
}

std::string lock_report_text(const LockReport& report) {
  std::string text = "lock " + std::to_string(report.lock.id) + ": charts " + chart_list(report.lock.charts) + " of " +
                     one_line(report.lock.mesh) + " for " + one_line(report.lock.owner) + " until " +
                     iso_time(report.lock.expires_us, false) + "\n";
  for (const LockInfo& stolen : report.stolen)
    text += "took over charts " + chart_list(stolen.charts) + " from " + one_line(stolen.owner) + ", locked until " +
            iso_time(stolen.expires_us, false) + (stolen.reason.empty() ? "" : ": " + one_line(stolen.reason)) + "\n";
  return text;
}

std::int64_t seconds_of(const std::string& text) {
  std::int64_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end + 1 != text.data() + text.size() || count < 1) return 0;
  const std::size_t unit = std::string("smhdw").find(*end);
  if (unit == std::string::npos) return 0;
  const std::int64_t seconds[] = {1, 60, 3600, 86'400, 604'800};
  return count > kMostSeconds / seconds[unit] ? 0 : count * seconds[unit];
}

}  // namespace ramcdb::cli
