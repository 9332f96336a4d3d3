#include "cli/size_table.h"

#include "cli/table.h"
#include "cli/text.h"

namespace ramcdb::cli {

std::string size_table(const MeshInfo& info) {
  const MeshBytes& bytes = info.bytes;
  const std::uint64_t overhead = bytes.wire_net + bytes.wires + bytes.chart_headers + bytes.tables;
  const std::uint64_t charts = bytes.connectivity + bytes.geometry;
  Table table({{"kind", Table::Align::left}, {"bytes"}, {"bits/vertex"}});
  const auto row = [&](const char* kind, std::uint64_t count) {
    table.add({kind, grouped(count), fixed(bits_per_vertex(count, info.vertices), 3)});
  };
  row("overhead", overhead);
  row("  wires", bytes.wires);
  row("  wire net", bytes.wire_net);
  row("  chart headers", bytes.chart_headers);
  row("  tables and record", bytes.tables);
  row("charts", charts);
  row("  connectivity", bytes.connectivity);
  row("  geometry", bytes.geometry);
  row("attributes", bytes.attributes);
  row("payload (all of the above)", bytes.payload);
  row("store (whole repository on disk)", bytes.store);
  std::string text = table.text();
  if (overhead + charts > 0) {
    const auto plain = static_cast<double>(12 * info.vertices + 12 * info.faces);
    text += "overhead and charts are " + fixed(plain / static_cast<double>(overhead + charts), 1) +
            " times smaller than plain float32 coordinates and 32-bit indices\n";
  }
  return text;
}

}  // namespace ramcdb::cli
