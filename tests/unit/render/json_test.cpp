// SPDX-License-Identifier: MIT
// The JSON writer against an independent reader, and on text that is no UTF-8.
#include "decoder/render/json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace servotrace {
namespace {

TEST(JsonWriter, WritesWhatAReaderReads) {
  std::string text;
  JsonWriter json(text);
  json.begin_object()
      .member("text", "a \"quote\", a \\ and a\ttab\nline \x01")
      .member("most", std::uint64_t{18446744073709551615U})
      .member("least", std::int64_t{INT64_MIN})
      .member("yes", true);
  json.key("none").null();
  json.key("number").raw("-0.125");
  json.key("list")
      .begin_array()
      .value(1)
      .value("two")
      .begin_object()
      .end_object()
      .begin_array()
      .end_array()
      .end_array();
  json.end_object();
  const nlohmann::json read = nlohmann::json::parse(text);
  EXPECT_EQ(read["text"], "a \"quote\", a \\ and a\ttab\nline \x01");
  EXPECT_EQ(read["most"], 18446744073709551615U);
  EXPECT_EQ(read["least"], INT64_MIN);
  EXPECT_EQ(read["yes"], true);
  EXPECT_TRUE(read["none"].is_null());
  EXPECT_EQ(read["number"], -0.125);
  EXPECT_EQ(read["list"].size(), 4U);
  EXPECT_EQ(text.find('\n'), std::string::npos);
}

TEST(JsonWriter, Indents) {
  std::string text;
  JsonWriter json(text, 2);
  json.begin_object().key("a").begin_array().value(1).value(2).end_array().key("b").begin_object().end_object();
  json.end_object();
  EXPECT_EQ(text, "{\n  \"a\": [\n    1,\n    2\n  ],\n  \"b\": {}\n}");
}

TEST(JsonString, KeepsUtf8AndReplacesEverythingElse) {
  const auto quoted = [](std::string_view text) {
    std::string out;
    append_json_string(out, text);
    return out;
  };
  EXPECT_EQ(quoted("\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80"), "\"\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80\"");
  EXPECT_EQ(quoted("a\xFFz"), "\"a\xEF\xBF\xBDz\"");
  EXPECT_EQ(quoted("\xC0\xAF"), "\"\xEF\xBF\xBD\xEF\xBF\xBD\"");                  // overlong
  EXPECT_EQ(quoted("\xED\xA0\x80"), "\"\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD\"");  // a surrogate
  EXPECT_EQ(quoted("\xE2\x82"), "\"\xEF\xBF\xBD\xEF\xBF\xBD\"");                  // cut
  for (unsigned first = 0; first < 256; ++first) {
    for (unsigned second = 0; second < 256; ++second) {
      const std::string text{static_cast<char>(first), static_cast<char>(second)};
      EXPECT_TRUE(nlohmann::json::accept(quoted(text))) << first << " " << second;
    }
  }
}

}  // namespace
}  // namespace servotrace
