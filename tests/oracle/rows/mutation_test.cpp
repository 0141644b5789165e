// SPDX-License-Identifier: MIT
// Every row of every layout against the manuals' tables, and the proof that a wrong row would be found: each row is
// changed in memory (its place, its width, its sign, its byte order, its place with its neighbour's), and either the
// checks of the compiler refuse the layout, or the manual's row reads something else.
#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "decoder/core/layout_check.hpp"
#include "decoder/pipeline/registry.hpp"
#include "tests/oracle/rows/rows.hpp"

namespace servotrace::test {
namespace {

std::string name_of(const Layout& layout, const Field& field) {
  return std::string(layout.protocol) + "." + std::string(layout.key) + "." + std::string(field.key) + " (" +
         std::string(layout.title) + ")";
}

// Empty where some row of the manual agrees with the field.
std::string judged(const OracleRows& rows, const Layout& layout, const Field& field) {
  std::string last = "no row in tests/oracle/rows";
  for (const OracleRow& row : rows.find(layout, field.key)) {
    last = complaint(row, layout, field);
    if (last.empty()) return {};
  }
  return last;
}

TEST(OracleRows, EveryFieldIsWhereTheManualSays) {
  const OracleRows rows = OracleRows::read_all();
  std::size_t fields = 0;
  for (const Layout* layout : all_layouts()) {
    for (const Field& field : layout->fields) {
      EXPECT_EQ(judged(rows, *layout, field), "") << name_of(*layout, field);
      ++fields;
    }
  }
  EXPECT_GT(fields, 1000U);
  EXPECT_GT(rows.size(), 500U);
}

using Mutation = std::function<bool(std::vector<Field>&, std::size_t)>;  // false: does not apply

bool is_number(const Field& field) { return field.kind != Kind::kBytes && field.kind != Kind::kText; }

bool move_by(Field& field, int bits) {
  if (static_cast<int>(field.first_bit) + bits < 0) return false;
  field.first_bit = static_cast<std::uint16_t>(static_cast<int>(field.first_bit) + bits);
  return true;
}

struct NamedMutation {
  const char* name;
  Mutation apply;
};

const NamedMutation kMutations[] = {
    {"a bit later", [](auto& fields, auto i) { return move_by(fields[i], 1); }},
    {"a bit earlier", [](auto& fields, auto i) { return move_by(fields[i], -1); }},
    {"a byte later", [](auto& fields, auto i) { return move_by(fields[i], 8); }},
    {"a byte earlier", [](auto& fields, auto i) { return move_by(fields[i], -8); }},
    {"wider",
     [](auto& fields, auto i) {
       if (fields[i].width == 0) return false;
       ++fields[i].width;
       return true;
     }},
    {"narrower",
     [](auto& fields, auto i) {
       if (fields[i].width < 2) return false;
       --fields[i].width;
       return true;
     }},
    {"another sign",
     [](auto& fields, auto i) {
       if (!is_number(fields[i]) || fields[i].width == 64) return false;  // 64 bits read the same with a sign
       fields[i].kind = fields[i].kind == Kind::kSigned ? Kind::kUnsigned : Kind::kSigned;
       return true;
     }},
    {"another byte order",
     [](auto& fields, auto i) {
       if (!is_number(fields[i]) || fields[i].byte_count() < 2) return false;
       fields[i].order = fields[i].order == ByteOrder::kBig ? ByteOrder::kLittle : ByteOrder::kBig;
       return true;
     }},
    // Two rows that keep the layout whole: only the manual's bytes can tell.
    {"in its neighbour's place",
     [](auto& fields, auto i) {
       if (i + 1 >= fields.size() || fields[i].width == 0 || fields[i + 1].width == 0) return false;
       if (fields[i].key == fields[i + 1].key) return false;
       Field& field = fields[i];
       Field& next = fields[i + 1];
       next.first_bit = field.first_bit;
       field.first_bit = static_cast<std::uint16_t>(field.first_bit + next.width);
       std::swap(field, next);
       return true;
     }},
    {"with a bit of its neighbour",
     [](auto& fields, auto i) {
       if (i + 1 >= fields.size() || fields[i].width == 0 || fields[i + 1].width < 2) return false;
       ++fields[i].width;
       ++fields[i + 1].first_bit;
       --fields[i + 1].width;
       return true;
     }},
};

// How a changed layout is found.
bool is_refused(const Layout& layout) {
  try {
    return !well_formed(layout);
  } catch (...) {
    return true;  // the compiler would not have evaluated it
  }
}

TEST(OracleRows, EveryMutationOfARowIsFound) {
  const OracleRows rows = OracleRows::read_all();
  std::size_t mutants = 0;
  std::size_t by_compiler = 0;
  for (const Layout* layout : all_layouts()) {
    for (std::size_t i = 0; i < layout->fields.size(); ++i) {
      for (const NamedMutation& mutation : kMutations) {
        std::vector<Field> fields(layout->fields.begin(), layout->fields.end());
        if (!mutation.apply(fields, i)) continue;
        Layout mutant = *layout;
        mutant.fields = fields;
        ++mutants;
        if (is_refused(mutant)) {
          ++by_compiler;
          continue;
        }
        bool found = false;
        for (const Field& field : fields) found = found || !judged(rows, mutant, field).empty();
        EXPECT_TRUE(found) << name_of(*layout, layout->fields[i]) << " " << mutation.name << " is not noticed";
      }
    }
  }
  RecordProperty("mutants", static_cast<int>(mutants));
  RecordProperty("refused_by_the_compiler", static_cast<int>(by_compiler));
  std::printf("%zu mutants, %zu refused while compiling, %zu by the manuals' rows\n", mutants, by_compiler,
              mutants - by_compiler);
  EXPECT_GT(mutants - by_compiler, 1000U);
}

}  // namespace
}  // namespace servotrace::test
