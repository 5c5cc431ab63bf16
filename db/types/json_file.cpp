// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/json_file.h"

#include "corpora_schema/embedded.h"
#include "db/types/errors.h"
#include "db/types/text.h"

#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>
#pragma GCC diagnostic pop

namespace phonomime {

nlohmann::json parse_json(std::string_view text, std::string_view where) {
  if (!is_valid_utf8(text)) {
    throw InputError(
        {.where = std::string(where), .what = "is not UTF-8 text", .expected = "JSON"});
  }
  // A parser of untrusted text must not be taken down by its nesting.
  constexpr int kDeepest = 64;
  const auto too_deep = [&](int depth, nlohmann::json::parse_event_t, nlohmann::json&) {
    if (depth > kDeepest) {
      throw InputError({.where = std::string(where),
                        .what = "JSON is nested too deeply",
                        .expected = fmt::format("at most {} levels", kDeepest)});
    }
    return true;
  };
  try {
    return nlohmann::json::parse(text, too_deep);
  } catch (const nlohmann::json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: ..."
    const std::string_view message = error.what();
    const std::size_t start = message.find("] ");
    throw InputError({.where = std::string(where),
                      .what = fmt::format("is not JSON: {}", start == std::string_view::npos
                                                                 ? message
                                                                 : message.substr(start + 2))});
  }
}

void validate_json(const nlohmann::json& value, std::string_view schema_name,
                   std::string_view where) {
  const std::string schema_file = fmt::format("schemas/{}.schema.json", schema_name);
  const nlohmann::json schema_json =
      nlohmann::json::parse(corpora_schema::embedded_file(schema_file));
  valijson::Schema schema;
  valijson::SchemaParser parser;
  parser.populateSchema(valijson::adapters::NlohmannJsonAdapter(schema_json), schema);
  valijson::Validator validator;
  valijson::ValidationResults results;
  if (validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(value), &results)) {
    return;
  }
  valijson::ValidationResults::Error first;
  results.popError(first);
  std::string member = "$";
  for (const std::string& step : first.context) {
    if (step != "<root>") {
      member += fmt::format("{}{}", step.starts_with('[') ? "" : ".", step);
    }
  }
  throw InputError({.where = std::string(where),
                    .what = fmt::format("{}: {}", member, first.description),
                    .remedy = fmt::format("See corpora_schema/{}.md.", schema_name)});
}

nlohmann::json parse_json_as(std::string_view schema, std::string_view text,
                             std::string_view where) {
  nlohmann::json value = parse_json(text, where);
  validate_json(value, schema, where);
  return value;
}

} // namespace phonomime
