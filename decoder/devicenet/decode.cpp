// SPDX-License-Identifier: MIT
#include "decoder/devicenet/decode.hpp"

#include "decoder/devicenet/objects.hpp"

namespace servotrace::devicenet {
namespace {

const Layout* request_layout(std::uint8_t body_format) {
  switch (body_format) {
    case 1:
      return &kRequest816;
    case 2:
      return &kRequest1616;
    case 3:
      return &kRequest168;
    case 4:
      return &kPathRequest;
    default:
      return &kRequest88;
  }
}

// Class, instance and attribute of a CIP path: logical segments of 8 and 16 bits. False where it holds anything else.
bool parse_path(Bytes path, Request& request) {
  std::size_t i = 0;
  while (i < path.size()) {
    const std::uint32_t segment = load_be(path, i, 1);
    std::uint32_t value = 0;
    if ((segment & 0xE3U) == 0x20U) {  // 8 bits
      if (i + 2 > path.size()) return false;
      value = load_le(path, i + 1, 1);
      i += 2;
    } else if ((segment & 0xE3U) == 0x21U) {  // a pad byte, then 16 bits
      if (i + 4 > path.size()) return false;
      value = load_le(path, i + 2, 2);
      i += 4;
    } else {
      return false;
    }
    const std::uint32_t what = segment >> 2U & 7U;
    if (what == 0) {
      request.class_id = static_cast<std::uint16_t>(value);
    } else if (what == 1) {
      request.instance = static_cast<std::uint16_t>(value);
    } else if (what == 4) {
      request.attribute = static_cast<std::int32_t>(value);
    }
  }
  return true;
}

// The bytes a value of this layout has at the front of `data`; 0: it does not fit.
std::size_t value_size(const Layout& layout, Bytes data) {
  if (!fits(layout, data)) return 0;
  if (layout.fields.empty() || layout.fields.back().width != 0) return layout.size;
  if (layout.fields.back().kind != Kind::kText) return data.size();
  const std::size_t text = load_be(data, 0, 1);  // a SHORT_STRING: its length, its text
  return text < data.size() ? 1 + text : 0;
}

const Layout* path_layout(std::uint32_t segment) {
  switch (segment) {
    case 0x20:
      return &kPathClass8;
    case 0x21:
      return &kPathClass16;
    case 0x24:
      return &kPathInstance8;
    case 0x25:
      return &kPathInstance16;
    case 0x30:
      return &kPathAttribute;
    default:
      return nullptr;
  }
}

// Segment by segment; from the first that is none of the logical ones on, as `otherwise`.
void show_path(Dissection& dissection, const Segment& base, Bytes message, std::size_t from, std::size_t end,
               const Layout& otherwise) {
  while (from < end) {
    const Layout* layout = path_layout(load_be(message, from, 1));
    if (layout != nullptr && layout->size > end - from) layout = nullptr;
    const std::size_t size = layout == nullptr ? end - from : layout->size;
    show(dissection, base, layout == nullptr ? otherwise : *layout, from, size);
    from += size;
  }
}

// The data of a service that no table describes.
const Layout& data_layout(std::uint8_t service) {
  if (service >= kFirstVendorService && service < kFirstObjectService) return kVendorData;
  return service >= kFirstObjectService && service < kEndObjectService ? kObjectData : kData;
}

// The values one behind the other from `from` on; what is left is no value's.
void show_values(Dissection& dissection, const Segment& base, Bytes message, std::size_t from, const Values& values,
                 const Layout& otherwise) {
  std::size_t at = from;
  for (const Layout* value : values) {
    if (at >= message.size()) return;
    const std::size_t size = value_size(*value, message.subspan(at));
    if (size == 0) break;
    if (is_path(*value)) {
      show_path(dissection, base, message, at, at + size, *value);
    } else {
      show(dissection, base, *value, at, size);
    }
    at += size;
  }
  show(dissection, base, at == from ? otherwise : kSurplus, at, message.size() - at);
}

}  // namespace

Request parse_request(Bytes message, std::uint8_t body_format) {
  Request request;
  if (message.empty()) {
    request.malformed = Malformation::kEmpty;
    return request;
  }
  request.header = static_cast<std::uint8_t>(load_be(message, 0, 1) & 0x7FU);
  request.layout = &kHeader;
  request.data_offset = 1;
  if (message.size() < 2) {
    request.malformed = Malformation::kHeaderOnly;
    return request;
  }
  request.service = static_cast<std::uint8_t>(read(slot(kService, "service"), message));
  request.response_bit = read(slot(kService, "response"), message) != 0;
  request.layout = &kService;
  request.data_offset = 2;
  const Layout* layout = request_layout(body_format);
  if (!fits(*layout, message)) {
    request.malformed = Malformation::kNoPath;
    return request;
  }
  if (layout == &kPathRequest) {
    const auto size = static_cast<std::size_t>(read(slot(kPathRequest, "path_size"), message)) * 2;
    if (message.size() < 3 + size || !parse_path(message.subspan(3, size), request)) {
      request.malformed = Malformation::kNoPath;
      return request;
    }
    request.layout = layout;
    request.data_offset = static_cast<std::uint32_t>(3 + size);
    return request;
  }
  request.class_id = static_cast<std::uint16_t>(read(slot_of(*layout->find("class")), message));
  request.instance = static_cast<std::uint16_t>(read(slot_of(*layout->find("instance")), message));
  request.layout = layout;
  request.data_offset = layout->size;
  const bool choice = request.service == kAllocateService || request.service == kReleaseService;
  if (choice && request.class_id == 3 && layout == &kRequest88) {
    const Layout& whole = request.service == kAllocateService ? kAllocate : kRelease;
    if (!fits(whole, message)) {
      request.malformed = Malformation::kNoChoice;
      return request;
    }
    request.layout = &whole;
    request.data_offset = whole.size;
    return request;
  }
  if (request.service == kGetAttribute || request.service == kSetAttribute) {
    if (message.size() <= request.data_offset) {
      request.malformed = Malformation::kNoAttribute;
      return request;
    }
    request.attribute = static_cast<std::int32_t>(load_be(message, request.data_offset, 1));
    ++request.data_offset;
  }
  return request;
}

Response parse_response(Bytes message, std::optional<std::uint8_t> request_service) {
  Response response;
  if (message.empty()) {
    response.malformed = Malformation::kEmpty;
    return response;
  }
  response.header = static_cast<std::uint8_t>(load_be(message, 0, 1) & 0x7FU);
  response.layout = &kHeader;
  response.data_offset = 1;
  if (message.size() < 2) {
    response.malformed = Malformation::kHeaderOnly;
    return response;
  }
  response.service = static_cast<std::uint8_t>(read(slot(kService, "service"), message));
  response.response_bit = read(slot(kService, "response"), message) != 0;
  response.layout = &kService;
  response.data_offset = 2;
  if (response.service == kErrorService && response.response_bit) {
    response.is_error = true;
    if (!fits(kError, message)) {
      response.malformed = Malformation::kNoErrorCodes;
      return response;
    }
    response.general_status = static_cast<std::uint8_t>(read(slot(kError, "general_status"), message));
    response.additional_status = static_cast<std::uint8_t>(read(slot(kError, "additional_status"), message));
    response.layout = &kError;
    response.data_offset = kError.size;
  } else if (response.service == kAllocateService && fits(kAllocated, message) &&
             request_service.value_or(kAllocateService) == kAllocateService) {
    response.layout = &kAllocated;
    response.data_offset = kAllocated.size;
  }
  return response;
}

void show(Dissection& dissection, const Segment& base, const Layout& layout, std::size_t offset, std::size_t length) {
  if (length == 0) return;
  Segment segment = base;
  segment.layout = &layout;
  segment.offset = base.offset + static_cast<std::uint32_t>(offset);
  segment.length = static_cast<std::uint32_t>(length);
  dissection.add(segment);
}

void show_request(Dissection& dissection, const Segment& base, Bytes message, const Request& request,
                  const Values& values, bool data_elsewhere) {
  if (request.layout == nullptr) return;
  show(dissection, base, *request.layout, 0, request.layout->size);
  std::size_t shown = request.layout->size;
  if (request.layout == &kPathRequest) {
    show_path(dissection, base, message, shown, request.data_offset, kData);
    shown = request.data_offset;
  } else if (request.attribute >= 0) {
    show(dissection, base, kAttribute, shown, 1);
    ++shown;
  }
  if (data_elsewhere && request.service == kSetAttribute) return;
  if (request.malformed == Malformation::kNone && request.service == kGetAttribute) {
    show(dissection, base, kSurplus, shown, message.size() - shown);
  } else {
    show_values(dissection, base, message, shown, values, data_layout(request.service));
  }
}

void show_response(Dissection& dissection, const Segment& base, Bytes message, const Response& response,
                   const Values& values, bool data_elsewhere) {
  if (response.layout == nullptr) return;
  show(dissection, base, *response.layout, 0, response.layout->size);
  if (data_elsewhere && !response.is_error) return;
  show_values(dissection, base, message, response.layout->size, response.is_error ? Values{} : values,
              response.is_error ? kData : data_layout(response.service));
}

}  // namespace servotrace::devicenet
