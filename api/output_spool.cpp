#include "api/output_spool.h"

#include <limits>
#include <numeric>

#include "api/spooled_edit.h"

namespace ramcdb::detail {

std::uint32_t VertexNumbers::number(const VertexKey& key) {
  if (key.where == VertexKey::Where::chart) return count_++;
  if (key.where == VertexKey::Where::corner) return take(corners_.try_emplace(key.id, count_).first->second);
  const Run run = wires_.try_emplace(key.id, Run{count_, key.index}).first->second;
  return take(run.from == 0 ? run.first + key.index : run.first + (run.from - key.index));
}

OutputSpool::OutputSpool(const Snapshot::Impl& at, const std::filesystem::path& folder,
                         std::vector<mesh_file::FaceColor> paint)
    : at_(at),
      folder_(folder),
      paint_(std::move(paint)),
      has_polygons_(at.layers().polygons() != nullptr),
      points_(folder),
      exact_(folder),
      corners_(folder),
      sizes_(folder),
      face_colors_(folder) {
  for (std::size_t i = 0; i < at.layers().layers.size(); ++i)
    if (const Layer& layer = at.layers().layers[i]; layer.coding != LayerCoding::polygons)
      values_.push_back({&layer, i, ScratchRecords<double>(folder)});
}

void OutputSpool::load(std::span<const ChartId> charts, std::uint64_t memory, unsigned threads, ReadCost& cost,
                       const std::function<void(double)>& progress) {
  constexpr std::uint64_t kBytesPerFace = 400;  // of a chart that is decoded, and more with each number of its layers
  std::uint64_t per_face = kBytesPerFace;
  for (const Values& values : values_) per_face += 3 * sizeof(std::uint64_t) * values.layer->info.components;
  std::size_t position = 0;
  for (const auto& batch : in_batches(at_, charts, memory, per_face, threads)) {
    ChartLoader loader(at_);
    for (const LoadedChart& chart : loader.load(batch, threads, &cost, true)) add(chart, position++);
    if (progress) progress(static_cast<double>(position) / static_cast<double>(charts.size()));
  }
  flush();
}

void OutputSpool::flush() {
  points_.flush();
  exact_.flush();
  corners_.flush();
  sizes_.flush();
  face_colors_.flush();
  for (Values& values : values_) values.numbers.flush();
}

void OutputSpool::add(const LoadedChart& chart, std::size_t position) {
  std::vector<std::uint32_t> vertex(chart.keys.size()), new_vertices;
  for (std::uint32_t v = 0; v < vertex.size(); ++v) {
    vertex[v] = numbers_.number(chart.keys[v]);
    if (vertex[v] < points_.size()) continue;
    points_.add(chart.chart.positions[v]);
    if (!chart.exact.empty()) exact_.add(chart.exact[v]);
    new_vertices.push_back(v);
  }
  add_faces(chart, vertex, position);
  for (Values& values : values_) add_values(values, chart, new_vertices);
}

void OutputSpool::add_faces(const LoadedChart& chart, const std::vector<std::uint32_t>& vertex, std::size_t position) {
  const std::vector<Triangle>& faces = chart.chart.faces;
  faces_ += faces.size();
  const std::size_t count = has_polygons_ ? chart.polygons.sizes.size() : faces.size();
  for (std::size_t f = 0; !paint_.empty() && f < count; ++f) face_colors_.add(paint_[position]);
  if (has_polygons_) {
    for (const std::uint32_t size : chart.polygons.sizes) sizes_.add(size);
    for (const std::uint32_t corner : chart.polygons.corners) corners_.add(vertex[faces[corner / 3][corner % 3]]);
  } else {
    for (const Triangle& face : faces)
      for (const std::uint32_t v : face) corners_.add(vertex[v]);
  }
}

namespace {

/// Which value of a chart's each of its corners or faces in the file has.
std::vector<std::uint32_t> file_order(const LoadedChart& chart, AttributeOf of, bool has_polygons) {
  std::vector<std::uint32_t> order;
  if (has_polygons && of == AttributeOf::corner) return chart.polygons.corners;
  if (has_polygons) {
    std::size_t corner = 0;
    for (const std::uint32_t size : chart.polygons.sizes) {
      order.push_back(chart.polygons.corners[corner] / 3);
      corner += size;
    }
    return order;
  }
  order.resize(chart.chart.faces.size() * (of == AttributeOf::corner ? 3 : std::size_t{1}));
  std::iota(order.begin(), order.end(), 0U);
  return order;
}

}  // namespace

void OutputSpool::add_values(Values& values, const LoadedChart& chart,
                             const std::vector<std::uint32_t>& new_vertices) const {
  const Layer& layer = *values.layer;
  const codec::LayerValues& coded = chart.layers[values.place];
  const std::size_t numbers = layer.shape().components;
  std::vector<double> value(layer.info.components);
  for (const std::uint32_t i :
       layer.info.of == AttributeOf::vertex ? new_vertices : file_order(chart, layer.info.of, has_polygons_)) {
    if (!coded.absent.empty() && coded.absent[i])
      value.assign(value.size(), std::numeric_limits<double>::quiet_NaN());
    else
      from_numbers(layer, std::span(coded.numbers).subspan(i * numbers, numbers), value);
    for (const double number : value) values.numbers.add(number);
  }
}

WrittenRegion OutputSpool::write(const Snapshot& snapshot, const std::filesystem::path& file,
                                 const FileOptions& options) const {
  const ScratchView points_view = points_.view(), exact_view = exact_.view();
  const MeshPoints points{at_.record().lattice, points_view.as<LatticePoint>(), exact_view.as<Point>()};
  const FileCoordinates coordinates =
      coordinates_for(points, at_.record().written_as, mesh_file::format_of(file), options, false);
  ScratchRecords<Point> positions(folder_);
  for (std::size_t v = 0; v < points.points.size(); ++v) positions.add(coordinates.in_file(points.position(v)));
  positions.flush();

  const ScratchView corners = corners_.view(), sizes = sizes_.view(), colors = face_colors_.view();
  OutputMesh mesh;
  mesh.corners = corners.as<std::uint32_t>();
  if (sizes_.size() < faces_) mesh.face_sizes = sizes.as<std::uint32_t>();
  mesh.face_colors = colors.as<mesh_file::FaceColor>();
  std::vector<ScratchView> numbers;
  for (const Values& values : values_) {
    numbers.push_back(values.numbers.view());
    mesh.attributes.emplace_back(values.layer->info, numbers.back().as<double>());
  }
  const ScratchView positions_view = positions.view();
  return write_output_mesh(snapshot, mesh, coordinates, positions_view.as<Point>(), file, options);
}

}  // namespace ramcdb::detail
