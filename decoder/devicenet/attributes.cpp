// SPDX-License-Identifier: MIT
// Requests against the object tables: names and values to show, and what a known drive does not allow.
#include "decoder/devicenet/bus.hpp"
#include "decoder/devicenet/derived.hpp"

namespace servotrace::devicenet {
namespace {

constexpr std::uint16_t kIdentityClass = 1;
constexpr std::uint16_t kLastStandardClass = 5;

struct Row {
  const ObjectClass* object = nullptr;
  const Attribute* attribute = nullptr;
};

Row find_row(std::span<const ObjectClass> classes, const Request& request, std::size_t size) {
  Row row{find_class(classes, request.class_id), nullptr};
  if (row.object != nullptr && request.attribute >= 0)
    row.attribute = row.object->find(static_cast<std::uint32_t>(request.attribute), size);
  return row;
}
Row find_row(std::span<const ObjectClass> classes, const Request& request) { return find_row(classes, request, 0); }

const Attribute* find_class_attribute(const Request& request) {
  return request.attribute < 0 ? nullptr : class_attributes().find(static_cast<std::uint32_t>(request.attribute));
}

// The profile's row where it has the attribute, else the standard one.
Row find_row(const Node& node, const Request& request) {
  if (node.profile != nullptr) {
    const Row row = find_row(node.profile->objects, request);
    if (row.attribute != nullptr || (row.object != nullptr && request.class_id > kLastStandardClass)) return row;
  }
  return find_row(standard_objects(), request);
}

}  // namespace

const Layout* Bus::value_layout(const Node& node, const Request& request, std::size_t size) const {
  const auto layout_in = [&](std::span<const ObjectClass> classes) -> const Layout* {
    const Row row = find_row(classes, request, size);
    return row.attribute == nullptr ? nullptr : row.object->layout_of(*row.attribute);
  };
  if (request.instance == 0) {
    const Attribute* const row = find_class_attribute(request);
    return row == nullptr ? nullptr : class_attributes().layout_of(*row);
  }
  const Layout* const own = node.profile == nullptr ? nullptr : layout_in(node.profile->objects);
  return own != nullptr ? own : layout_in(standard_objects());
}

Values Bus::request_values(const Node& node, const Request& request, std::size_t size) const {
  Values values;
  if (request.service == kResetService && request.class_id == kIdentityClass) values.push_back(&kResetType);
  if (request.service != kSetAttribute) return values;
  if (const Layout* const layout = value_layout(node, request, size)) values.push_back(layout);
  return values;
}

// What the response to `request` returns: the attribute, or of Identity all of them (1 to 7) one behind the other.
Values Bus::response_values(const Node& node, const Request& request, std::size_t size) const {
  Values values;
  if (request.service == kGetAttribute || request.service == kSetAttribute) {
    if (const Layout* const layout = value_layout(node, request, size)) values.push_back(layout);
  } else if (request.service == kGetAttributesAll && request.class_id == kIdentityClass && request.instance != 0) {
    Request one = request;
    for (one.attribute = 1; one.attribute <= 7; ++one.attribute) {
      if (const Layout* const layout = value_layout(node, one, 0)) values.push_back(layout);
    }
  }
  return values;
}

// A drive's session shows the values of attributes its profile lists without layouts.
bool Bus::shown_by_session(const Node& node, const Request& request) const {
  if (!node.session || !devicenet_ || request.class_id <= kLastStandardClass) return false;
  const Row row = find_row(node.profile->objects, request);
  return row.attribute != nullptr && row.object->layouts.empty();
}

void Bus::show_names(const Arrival& arrival, const Node& node, const Request& request) const {
  Dissection* const dissection = arrival.context.dissection;
  derive(dissection, kServiceNameField, 0, node.ref, name_of_service(request.service));
  const Row row = find_row(node, request);
  if (row.object != nullptr) derive(dissection, kObjectNameField, 0, node.ref, row.object->name);
  const Attribute* const attribute = request.instance == 0 ? find_class_attribute(request) : row.attribute;
  if (attribute != nullptr) derive(dissection, kAttributeNameField, 0, node.ref, attribute->name);
}

// The first that applies of: object, instance, service, attribute, access, length, range.
void Bus::check_attribute(const Arrival& arrival, Node& node, const Request& request, Bytes data) {
  if (!node.known_drive() || node.profile->objects.empty()) return;
  const Row row = find_row(node.profile->objects, request, data.size());
  if (row.object == nullptr && request.class_id <= kLastStandardClass) return;  // the profile leaves it to DeviceNet
  static constexpr RuleId kChecks[] = {rule("DN402"), rule("DN403"), rule("DN404"), rule("DN405")};
  for (const RuleId check : kChecks) checked(check);
  const auto found = [&](RuleId id, std::array<std::int64_t, kMaxArguments> arguments, ByteRange where,
                         std::int64_t variant) {
    for (const RuleId check : kChecks) {
      if (check != id) findings_.calm(node.explicit_owner, check);
    }
    raise(arrival.context, {.rule = id,
                            .owner = node.explicit_owner,
                            .arguments = arguments,
                            .where = where,
                            .basis = node.drive_basis(),
                            .variant = variant << 48U | std::int64_t{request.class_id} << 32U |
                                       std::int64_t{request.instance} << 16U | (request.attribute & 0xFFFF)});
  };
  const auto unknown = [&](std::int64_t kind) {
    found(rule("DN405"), {kind, request.class_id, request.instance, request.attribute}, arrival.all(), kind);
  };
  const auto access = [&](std::int64_t kind) {
    found(rule("DN402"), {kind, request.class_id, request.attribute, request.service}, arrival.all(),
          kind << 8U | request.service);
  };
  if (row.object == nullptr) return unknown(0);
  if (request.instance < row.object->first_instance || request.instance > row.object->last_instance) return unknown(1);
  if (!row.object->has_service(request.service)) return access(1);
  if (request.service == kGetAttribute || request.service == kSetAttribute) {
    if (row.attribute == nullptr) return unknown(2);
    const Attribute& attribute = *row.attribute;
    if (request.service == kSetAttribute) {
      if (attribute.access == Access::kGet) return access(0);
      const std::size_t size = size_of(attribute.type);
      if (size != 0 && data.size() != size) {
        found(rule("DN404"),
              {attribute.number, static_cast<std::int64_t>(data.size()), static_cast<std::int64_t>(size),
               request.class_id},
              arrival.all(), 0);
        return;
      }
      const bool ranged = attribute.range.minimum != 0 || attribute.range.maximum != 0;
      if (size != 0 && ranged) {
        std::int64_t value = load_le(data, 0, static_cast<unsigned>(size));
        if (is_signed(attribute.type) && (value >> (size * 8 - 1) & 1) != 0) value -= std::int64_t{1} << (size * 8);
        if (value < attribute.range.minimum || value > attribute.range.maximum) {
          found(rule("DN403"), {attribute.number, value, attribute.range.minimum, attribute.range.maximum},
                arrival.all(), 0);
          return;
        }
      }
    }
  }
  for (const RuleId check : kChecks) findings_.calm(node.explicit_owner, check);
}

// Some drives answer a Get of an attribute their manual lists as set-only: a note, once it succeeded.
void Bus::check_get_of_set_only(const Arrival& arrival, Node& node, const PendingRequest& pending) {
  const Request& request = pending.request;
  if (request.service != kGetAttribute || !node.known_drive()) return;
  const Row row = find_row(node.profile->objects, request);
  if (row.attribute == nullptr || row.attribute->access != Access::kSet) return;
  raise(arrival.context,
        {.rule = rule("DN402"),
         .owner = node.explicit_owner,
         .arguments = {2, request.class_id, request.attribute, request.service},
         .where = arrival.all(),
         .related = {pending.frame, 0},
         .basis = node.drive_basis(),
         .variant = std::int64_t{2} << 56U | std::int64_t{request.class_id} << 32U | (request.attribute & 0xFFFF),
         .as_note = true});
}

}  // namespace servotrace::devicenet
