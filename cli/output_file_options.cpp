#include "cli/output_file_options.h"

#include <CLI/CLI.hpp>

namespace ramcdb::cli {
namespace {

Paint paint_of(const std::string& color) {
  if (color == "chart") return Paint::chart;
  if (color == "bits") return Paint::bits;
  if (color == "version") return Paint::version;
  return Paint::none;
}

}  // namespace

void add_output_file(CLI::App& verb, OutputFileOptions& options) {
  verb.add_option("-o,--output", options.file, "The file to write; its extension says the format")
      ->type_name("FILE")
      ->required();
  verb.add_flag("--force", options.force, "Overwrite the file even if an edit would be lost");
  verb.add_option("--color", options.color,
                  "Paint the faces by chart, bits (per vertex) or version (of the last change); "
                  "such a file is to look at, commit refuses it")
      ->type_name("chart|bits|version")
      ->check(CLI::Validator(CLI::IsMember({"chart", "bits", "version"})).description(""));
  verb.add_flag("--ascii", options.ascii, "PLY as text");
}

FileOptions file_options_of(const OutputFileOptions& options) {
  FileOptions file;
  file.paint = paint_of(options.color);
  file.ascii = options.ascii;
  file.overwrite = options.force;
  return file;
}

}  // namespace ramcdb::cli
