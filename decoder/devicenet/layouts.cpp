// SPDX-License-Identifier: MIT
#include "decoder/devicenet/layouts.hpp"

#include <vector>

#include "decoder/devicenet/derived.hpp"
#include "decoder/devicenet/objects.hpp"

namespace servotrace::devicenet {

std::span<const Layout* const> layouts() {
  static const std::vector<const Layout*> kAll = [] {
    std::vector<const Layout*> all{
        &kMacCheck,     &kHeader,           &kService,         &kRequest88,       &kRequest816,
        &kRequest1616,  &kRequest168,       &kPathRequest,     &kAttribute,       &kData,
        &kError,        &kAllocate,         &kRelease,         &kAllocated,       &kFragment,
        &kFragmentAck,  &kFragmentData,     &kUnconnected,     &kOpenRequest,     &kOpenResponse,
        &kCloseRequest, &kUnconnectedError, &kShutdown,        &kUnconnectedData, &kFaulted,
        &kFaultedData,  &kOwnership,        &kOwnershipVendor, &kOwnershipHead,   &kOwnershipData,
        &kIoData,       &kBitStrobe,        &kErrorFrame,      &kSurplus,         &kResetType,
        &kPathClass8,   &kPathClass16,      &kPathInstance8,   &kPathInstance16,  &kPathAttribute,
        &kHeartbeat,    &kVendorData,       &kObjectData};
    for (const Layout& layout : class_attributes().layouts) all.push_back(&layout);
    for (const ObjectClass& object : standard_objects()) {
      for (const Layout& layout : object.layouts) all.push_back(&layout);
    }
    return all;
  }();
  return kAll;
}

std::span<const Field* const> derived() {
  static const std::vector<const Field*> kAll = [] {
    std::vector<const Field*> all{
        &kIdentifierField,  &kGroupField,          &kMessageIdField,     &kMessageField,        &kSourceField,
        &kDestinationField, &kMulticastGroupField, &kCheckedField,       &kIdleField,           &kAmbiguousField,
        &kServiceNameField, &kObjectNameField,     &kAttributeNameField, &kResponseTimeField,   &kPollIntervalField,
        &kPollStateField,   &kErrorClassField,     &kScannerCodeField,   &kRetransmissionField, &kAllocationErrorField};
    for (const Field& bit : kErrorBits) all.push_back(&bit);
    return all;
  }();
  return kAll;
}

}  // namespace servotrace::devicenet
