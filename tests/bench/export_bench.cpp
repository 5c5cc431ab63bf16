// SPDX-License-Identifier: GPL-3.0-or-later
#include "synth/export/motion_csv.h"
#include "tests/bench/compare.h"
#include "tests/synth/search/random_tables.h"

#include <iomanip>
#include <sstream>

#include <benchmark/benchmark.h>

namespace phonomime {
namespace {

// The same table through an ordinary stream.
std::string plain_marker_csv(const Layout& layout, const PcaModel& pca,
                             const CoefficientMotion& motion) {
  std::ostringstream text;
  text << "time";
  for (const ChannelGroup& group : layout.groups) {
    text << ',' << group.name << "_x," << group.name << "_y," << group.name << "_z";
  }
  text << '\n' << std::fixed;
  for (Eigen::Index frame = 0; frame < motion.coefficients.rows(); ++frame) {
    text << std::setprecision(6) << static_cast<double>(frame) / motion.rate_hz
         << std::setprecision(4);
    for (const double value : pca.reconstruct(motion.coefficients.row(frame).transpose())) {
      text << ',' << value;
    }
    text << '\n';
  }
  return text.str();
}

void marker_csv_against_a_stream(benchmark::State& state) {
  test::Draw draw(2);
  test::TableShape shape;
  shape.groups = 91;
  shape.dimensions = 25;
  shape.sentences = 20;
  const MotionTable table = test::random_table(shape, draw);
  CoefficientMotion motion;
  motion.rate_hz = 30.0;
  motion.coefficients = table.coefficients.topRows(180).cast<double>();
  const std::string ours = marker_csv(table.layout, table.pca, motion, false);
  std::string plain = plain_marker_csv(table.layout, table.pca, motion);
  for (std::size_t at; (at = plain.find(",-0.0000")) != std::string::npos;) {
    plain.erase(at + 1, 1); // the one difference that is meant
  }
  bench::verify(ours == plain, "the CSV is not what a stream writes");
  bench::compare(
      state, [&] { return marker_csv(table.layout, table.pca, motion, false).size(); },
      [&] { return plain_marker_csv(table.layout, table.pca, motion).size(); });
}
BENCHMARK(marker_csv_against_a_stream)
    ->Iterations(10)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace phonomime
