// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/db/import/readers/c3d_writer.h"

#include <bit>
#include <cmath>

namespace phonomime::test {

namespace {

constexpr std::size_t kBlock = 512;

class Bytes {
public:
  explicit Bytes(int processor) : processor_(processor) {}

  void byte(int value) { bytes += static_cast<char>(value); }
  void word(int value) {
    const int low = value & 0xFF;
    const int high = value >> 8 & 0xFF;
    byte(processor_ == 86 ? high : low);
    byte(processor_ == 86 ? low : high);
  }
  void real(double value) {
    const std::uint32_t bits = processor_ == 85
                                   ? dec_bits(value)
                                   : std::bit_cast<std::uint32_t>(static_cast<float>(value));
    const int low = static_cast<int>(bits & 0xFFFF);
    const int high = static_cast<int>(bits >> 16);
    word(processor_ == 84 ? low : high); // DEC: the more significant word first
    word(processor_ == 84 ? high : low);
  }
  void pad() { bytes.resize((bytes.size() + kBlock - 1) / kBlock * kBlock, '\0'); }

  std::string bytes;

private:
  static std::uint32_t dec_bits(double value) {
    if (value == 0.0) {
      return 0;
    }
    int exponent = 0;
    const double fraction = std::frexp(std::abs(value), &exponent); // 0.5 to 1
    const auto mantissa = static_cast<std::uint32_t>(std::lround(fraction * (1 << 24)));
    return (value < 0.0 ? 1u << 31 : 0u) | static_cast<std::uint32_t>(exponent + 128) << 23 |
           (mantissa & 0x7FFFFF);
  }

  int processor_;
};

void write_record(Bytes& out, const std::string& name, int group, const C3dFile::Value* value) {
  out.byte(static_cast<int>(name.size()));
  out.byte(group);
  out.bytes += name;
  Bytes body = out;
  body.bytes.clear();
  if (value != nullptr) {
    body.byte(value->type);
    body.byte(static_cast<int>(value->dimensions.size()));
    for (const int dimension : value->dimensions) {
      body.byte(dimension);
    }
    body.bytes += value->text;
    for (const double number : value->numbers) {
      if (value->type == 4) {
        body.real(number);
      } else if (value->type == 2) {
        body.word(static_cast<int>(number));
      } else {
        body.byte(static_cast<int>(number));
      }
    }
  }
  body.byte(0); // no description
  out.word(static_cast<int>(body.bytes.size()) + 2);
  out.bytes += body.bytes;
}

C3dFile::Value text_row(const std::vector<std::string>& texts, int length) {
  C3dFile::Value value{.type = -1,
                       .dimensions = {length, static_cast<int>(texts.size())},
                       .numbers = {},
                       .text = {}};
  for (std::string text : texts) {
    text.resize(static_cast<std::size_t>(length), ' ');
    value.text += text;
  }
  return value;
}

std::map<std::string, C3dFile::Value> all_parameters(const C3dFile& file, int data_block) {
  std::map<std::string, C3dFile::Value> values;
  values["POINT:USED"] = c3d_word(static_cast<int>(file.labels.size()));
  values["POINT:SCALE"] = c3d_real(file.floats ? -file.scale : file.scale);
  values["POINT:RATE"] = c3d_real(file.rate_hz);
  values["POINT:DATA_START"] = c3d_word(data_block);
  values["POINT:FRAMES"] = c3d_word(std::min(file.frames, 65535));
  values["POINT:UNITS"] = {.type = -1,
                           .dimensions = {static_cast<int>(file.units.size())},
                           .numbers = {},
                           .text = file.units};
  for (std::size_t part = 0; part * 255 < file.labels.size(); ++part) {
    const auto begin = file.labels.begin() + static_cast<std::ptrdiff_t>(part * 255);
    const auto end = file.labels.begin() +
                     static_cast<std::ptrdiff_t>(std::min(file.labels.size(), (part + 1) * 255));
    values[part == 0 ? "POINT:LABELS" : "POINT:LABELS" + std::to_string(part + 1)] =
        text_row({begin, end}, file.label_length);
  }
  values["ANALOG:USED"] = c3d_word(file.analog_channels);
  values["ANALOG:RATE"] = c3d_real(file.rate_hz * file.analog_per_frame);
  for (const auto& [name, value] : file.parameters) {
    values[name] = value;
  }
  std::erase_if(values, [](const auto& entry) { return entry.second.omit; });
  return values;
}

Bytes parameter_section(const C3dFile& file, int data_block) {
  const std::map<std::string, int> groups = {{"POINT", 1}, {"ANALOG", 2}, {"TRIAL", 3}};
  Bytes out(file.processor);
  out.byte(1);
  out.byte(0x50);
  out.byte(data_block - 2);
  out.byte(file.processor);
  for (const auto& [name, number] : groups) {
    write_record(out, name, -number, nullptr);
  }
  for (const auto& [name, value] : all_parameters(file, data_block)) {
    const std::size_t colon = name.find(':');
    write_record(out, name.substr(colon + 1), groups.at(name.substr(0, colon)), &value);
  }
  if (file.end_mark) {
    out.byte(0);
    out.byte(0);
  }
  out.pad();
  return out;
}

} // namespace

C3dFile::Value c3d_word(int value) {
  return {.type = 2, .dimensions = {}, .numbers = {value * 1.0}, .text = {}};
}
C3dFile::Value c3d_words(std::vector<double> values) {
  const int count = static_cast<int>(values.size());
  return {.type = 2, .dimensions = {count}, .numbers = std::move(values), .text = {}};
}
C3dFile::Value c3d_real(double value) {
  return {.type = 4, .dimensions = {}, .numbers = {value}, .text = {}};
}
C3dFile::Value c3d_omit() {
  return {.type = 2, .dimensions = {}, .numbers = {}, .text = {}, .omit = true};
}

std::string write_c3d(const C3dFile& file) {
  const int data_block = 2 + static_cast<int>(parameter_section(file, 3).bytes.size() / kBlock);
  const int samples = file.analog_channels * file.analog_per_frame;
  std::map<int, int> words = {{1, 2 | 0x50 << 8},
                              {2, static_cast<int>(file.labels.size())},
                              {3, samples},
                              {4, file.first_frame},
                              {5, std::min(file.first_frame + file.frames - 1, 65535)},
                              {6, 10},
                              {9, data_block},
                              {10, file.analog_per_frame}};
  for (const auto& [word, value] : file.header_words) {
    words[word] = value;
  }
  Bytes out(file.processor);
  for (int word = 1; word <= 12; ++word) {
    if (word == 1) {
      out.byte(words[1] & 0xFF);
      out.byte(words[1] >> 8 & 0xFF);
    } else if (word == 7 || word == 11) {
      out.real(word == 11 ? file.rate_hz : file.floats ? -file.scale : file.scale);
      ++word;
    } else {
      out.word(words[word]);
    }
  }
  out.pad();
  out.bytes += parameter_section(file, data_block).bytes;
  for (int frame = 0; frame < file.frames; ++frame) {
    for (std::size_t i = 0; i < file.labels.size(); ++i) {
      const C3dFile::Point p = file.point(frame, static_cast<int>(i));
      for (const double value : {p.x, p.y, p.z}) {
        file.floats ? out.real(value) : out.word(static_cast<int>(std::lround(value / file.scale)));
      }
      file.floats ? out.real(p.residual) : out.word(static_cast<int>(p.residual));
    }
    for (int i = 0; i < samples; ++i) {
      file.floats ? out.real(-7.0) : out.word(-7);
    }
  }
  out.pad();
  return out.bytes;
}

} // namespace phonomime::test
