#pragma once

#include <cstdint>
#include <string>

#include "ramcdb/repository.h"

namespace CLI {
class App;
}

/// Options that several verbs share, so that they read and mean the same everywhere.
namespace ramcdb::cli {

/// How a verb speaks.
struct OutputMode {
  bool json = false;   ///< one JSON object on standard output, nothing else there
  bool quiet = false;  ///< no progress, and no report of what was done
};
void add_output_mode(CLI::App& verb, OutputMode& mode);

/// REPO, a positional.
void add_repository(CLI::App& verb, std::string& folder);

/// FILE, a positional: a checked-out file.
void add_checked_out_file(CLI::App& verb, std::string& file);

/// Which mesh at which version.
struct MeshAt {
  std::string mesh;  ///< empty: the only one
  std::string at;    ///< empty: the tip of main
};
void add_mesh(CLI::App& verb, MeshAt& which);
void add_at(CLI::App& verb, MeshAt& which);

/// -j/--threads; sets `threads` to the number of cores first.
void add_threads(CLI::App& verb, unsigned& threads);

/// --memory SIZE: 512M, 4G; sets `bytes` to 1 GB first. \param what the help says of it, the default aside
void add_memory(CLI::App& verb, std::uint64_t& bytes,
                const std::string& what = "Memory to work in; it changes the time, never the result");

/// -m/--message, required and not empty, where `required`.
void add_message(CLI::App& verb, std::string& message, bool required);

/// $RAMCDB_AUTHOR, else user@host, else "unknown".
[[nodiscard]] std::string default_author();

/// --author; sets `author` to default_author() first.
void add_author(CLI::App& verb, std::string& author);

/// Adds the verb's example to its help: a command line as it can be pasted. \param notes lines above it
void add_example(CLI::App& verb, const std::string& command, const std::string& notes = {});

}  // namespace ramcdb::cli
