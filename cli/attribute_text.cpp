#include "cli/attribute_text.h"

#include "cli/text.h"

namespace ramcdb::cli {

std::string name_of(AttributeOf of) {
  return of == AttributeOf::vertex ? "vertex" : of == AttributeOf::corner ? "corner" : "face";
}

std::string name_of(NumberType type) {
  constexpr const char* kNames[] = {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"};
  return kNames[static_cast<std::size_t>(type) - 1];
}

std::string name_of(Meaning meaning) {
  constexpr const char* kNames[] = {"other", "color", "normal", "texture", "material", "group"};
  return kNames[static_cast<std::size_t>(meaning) - 1];
}

std::string attribute_text(const MeshInfo::Layer& layer) {
  const AttributeInfo& info = layer.info;
  const std::string numbers = (info.components > 1 ? std::to_string(info.components) + " x " : "") + name_of(info.type);
  const std::string names = info.names.empty() ? "" : ", " + counted(info.names.size(), "name");
  const std::string loss =
      layer.max_error > 0 ? "error at most " + model_units(layer.max_error) : std::string("without loss");
  const std::string plural = info.of == AttributeOf::vertex ? "vertices" : name_of(info.of) + "s";
  return one_line(info.name) + " of " + plural + " (" + numbers + names + "), " + loss;
}

std::string left_out_text(const std::vector<ImportReport::Dropped>& left_out) {
  std::string text;
  for (const auto& dropped : left_out)
    text +=
        "left out: " + one_line(dropped.what) + " (" + grouped(dropped.count) + "), which this format cannot hold\n";
  return text;
}

}  // namespace ramcdb::cli
