// SPDX-License-Identifier: GPL-3.0-or-later
#include "db/types/json_file.h"

#include "corpora_schema/embedded.h"
#include "db/types/errors.h"
#include "db/types/text.h"

#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
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

namespace {

using nlohmann::json;

// Where in a value, and where in its schema, something does not fit.
struct Mismatch {
  std::string path = "$";
  const json* value;
  const json* schema; // null where the schema says nothing about the place
};

const json* schema_of_step(const json& schema, const json& root, const json& value,
                           const std::string& step) {
  const json* found = nullptr;
  if (value.is_array()) {
    found = schema.contains("items") ? &schema.at("items") : nullptr;
  } else if (schema.contains("properties") && schema.at("properties").contains(step)) {
    found = &schema.at("properties").at(step);
  } else if (schema.contains("additionalProperties")) {
    found = &schema.at("additionalProperties");
  }
  if (found != nullptr && found->contains("$ref")) {
    const std::string reference = found->at("$ref").get<std::string>();
    found = &root.at(json::json_pointer(reference.substr(1)));
  }
  return found;
}

// `steps` as valijson gives them: "<root>", "[groups]", "[0]", "[name]".
Mismatch locate(const std::vector<std::string>& steps, const json& value, const json& schema) {
  Mismatch place{.value = &value, .schema = &schema};
  for (const std::string& bracketed : steps) {
    if (!bracketed.starts_with('[')) {
      continue;
    }
    const std::string step = bracketed.substr(1, bracketed.size() - 2);
    place.schema = place.schema == nullptr
                       ? nullptr
                       : schema_of_step(*place.schema, schema, *place.value, step);
    if (place.value->is_array()) {
      place.path += bracketed;
      place.value = &place.value->at(std::stoul(step));
    } else {
      place.path += fmt::format(".{}", step);
      place.value = &place.value->at(step);
    }
  }
  return place;
}

std::string text_of(const json& value) {
  if (value.is_structured()) {
    return value.type_name();
  }
  return value.is_string() ? quoted(value.get_ref<const std::string&>()) : value.dump();
}

// What is wrong in an object: a member that is missing, or one that the schema does not know.
std::optional<ErrorDetails> explain_members(const Mismatch& place) {
  for (const json& name : place.schema->value("required", json::array())) {
    if (!place.value->contains(name.get_ref<const std::string&>())) {
      return ErrorDetails{.what = fmt::format("{}: member {} is missing", place.path, name.dump())};
    }
  }
  if (place.schema->value("additionalProperties", json()) != json(false)) {
    return std::nullopt;
  }
  const json members = place.schema->value("properties", json::object());
  std::vector<std::string> known;
  for (const auto& [name, schema] : members.items()) {
    known.push_back(name);
  }
  for (const auto& [name, value] : place.value->items()) {
    if (!members.contains(name) && !name.starts_with("x-")) {
      return ErrorDetails{.what =
                              fmt::format("{}: there is no member {}", place.path, quoted(name)),
                          .remedy = did_you_mean(name, known)};
    }
  }
  return std::nullopt;
}

ErrorDetails explain(const Mismatch& place, std::string_view description) {
  if (place.schema != nullptr && place.value->is_object()) {
    if (const std::optional<ErrorDetails> details = explain_members(place)) {
      return *details;
    }
  }
  ErrorDetails details{.got = text_of(*place.value)};
  if (place.schema != nullptr && place.schema->contains("enum")) {
    std::vector<std::string> values;
    for (const json& value : place.schema->at("enum")) {
      values.push_back(value.dump());
    }
    details.what = place.path + " has an unknown value";
    details.expected = fmt::format("{}", fmt::join(values, ", "));
  } else if (place.schema != nullptr && description.find("'type'") != std::string_view::npos) {
    details.what = place.path + " has the wrong type";
    const json& type = place.schema->at("type");
    details.expected = type.is_array() ? type.dump() : type.get<std::string>();
  } else {
    details.what = fmt::format("{}: {}", place.path,
                               description.substr(0, description.find_last_not_of('.') + 1));
  }
  return details;
}

} // namespace

nlohmann::json parse_json(std::string_view text, std::string_view where) {
  if (!is_valid_utf8(text)) {
    throw InputError(
        {.where = std::string(where), .what = "is not UTF-8 text", .expected = "JSON"});
  }
  // A parser of untrusted text must not be taken down by its nesting.
  constexpr int kDeepest = 64;
  std::vector<std::set<std::string>> members; // of the objects that the parser is in
  const auto check = [&](int depth, json::parse_event_t event, const json& parsed) {
    if (depth > kDeepest) {
      throw InputError({.where = std::string(where),
                        .what = "JSON is nested too deeply",
                        .expected = fmt::format("at most {} levels", kDeepest)});
    }
    if (event == json::parse_event_t::object_start) {
      members.emplace_back();
    } else if (event == json::parse_event_t::object_end) {
      members.pop_back();
    } else if (event == json::parse_event_t::key &&
               !members.back().insert(parsed.get<std::string>()).second) {
      throw InputError({.where = std::string(where),
                        .what = fmt::format("member {} stands twice in one object", parsed.dump()),
                        .remedy = "Remove one of the two."});
    }
    return true;
  };
  try {
    return nlohmann::json::parse(text, check);
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
  const json schema_json = nlohmann::json::parse(corpora_schema::embedded_file(schema_file));
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
  ErrorDetails details = explain(locate(first.context, value, schema_json), first.description);
  details.where = where;
  details.remedy +=
      fmt::format("{}See corpora_schema/{}.md.", details.remedy.empty() ? "" : " ", schema_name);
  throw InputError(details);
}

nlohmann::json parse_json_as(std::string_view schema, std::string_view text,
                             std::string_view where) {
  nlohmann::json value = parse_json(text, where);
  validate_json(value, schema, where);
  return value;
}

} // namespace phonomime
