#include "tools/benchmark/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "tools/benchmark/timing.h"

namespace ramcdb::benchmark {
namespace {

constexpr double kWidth = 760, kHeight = 440, kLeft = 70, kBottom = 60, kTop = 30, kRight = 150;

struct Dot {
  std::string name;
  double size, speed;
};

std::vector<Dot> dots_of(const std::vector<CoderFigures>& figures) {
  std::vector<Dot> dots;
  for (const Contestant& contestant : figures.front().contestants) {
    double log_sum = 0;
    std::vector<double> speeds;
    for (const CoderFigures& f : figures) {
      const Contestant& c = f.find(contestant.name);
      log_sum += std::log(c.bits_per_vertex() / f.find("Draco cl10").bits_per_vertex());
      speeds.push_back(c.decode / 1e6);
    }
    dots.push_back({contestant.name, std::exp(log_sum / static_cast<double>(figures.size())), median(speeds)});
  }
  return dots;
}

/// A logarithmic axis that numbers are put on.
class Axis {
 public:
  Axis(double least, double most, double from, double to) : least_(least), most_(most), from_(from), to_(to) {}
  [[nodiscard]] double at(double x) const {
    return from_ + (to_ - from_) * std::log(x / least_) / std::log(most_ / least_);
  }
  [[nodiscard]] std::vector<double> marks() const {
    std::vector<double> marks;
    for (double decade = 0.01; decade < 10'000; decade *= 10)
      for (const double digit : {1.0, 2.0, 5.0})
        if (digit * decade >= least_ && digit * decade <= most_) marks.push_back(digit * decade);
    return marks;
  }

 private:
  double least_, most_, from_, to_;
};

}  // namespace

void write_plot(const std::vector<CoderFigures>& figures, const std::filesystem::path& file) {
  const std::vector<Dot> dots = dots_of(figures);
  const auto [slow, quick] =
      std::minmax_element(dots.begin(), dots.end(), [](const Dot& a, const Dot& b) { return a.speed < b.speed; });
  const auto [small, large] =
      std::minmax_element(dots.begin(), dots.end(), [](const Dot& a, const Dot& b) { return a.size < b.size; });
  const Axis x(slow->speed / 1.5, quick->speed * 1.5, kLeft, kWidth - kRight);
  const Axis y(small->size / 1.2, large->size * 1.2, kHeight - kBottom, kTop);
  std::ofstream out(file);
  out << fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      kWidth, kHeight);
  for (const double mark : x.marks())
    out << fmt::format(
        "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\" stroke=\"#ddd\"/><text x=\"{0:.1f}\" y=\"{3}\" "
        "text-anchor=\"middle\">{4:g}</text>\n",
        x.at(mark), kTop, kHeight - kBottom, kHeight - kBottom + 18, mark);
  for (const double mark : y.marks())
    out << fmt::format(
        "<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" stroke=\"#ddd\"/><text x=\"{3}\" y=\"{4:.1f}\" "
        "text-anchor=\"end\">{5:g}</text>\n",
        kLeft, kWidth - kRight, y.at(mark), kLeft - 8, y.at(mark) + 4, mark);
  out << fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">decoding, Mtri/s on one core</text>\n",
                     (kLeft + kWidth - kRight) / 2, kHeight - 15);
  out << fmt::format("<text x=\"{}\" y=\"18\">size, Draco cl10 = 1 (geometric mean of {} meshes)</text>\n", kLeft,
                     figures.size());
  for (const Dot& dot : dots) {
    const bool ours = dot.name.starts_with("dense") || dot.name.starts_with("fast");
    out << fmt::format(
        "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"5\" fill=\"{2}\"/><text x=\"{3:.1f}\" y=\"{4:.1f}\">{5}</text>\n",
        x.at(dot.speed), y.at(dot.size), ours ? "#c22" : "#347", x.at(dot.speed) + 9, y.at(dot.size) + 4, dot.name);
  }
  out << "</svg>\n";
}

}  // namespace ramcdb::benchmark
