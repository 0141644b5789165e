// SPDX-License-Identifier: MIT
// Explicit messages: what they teach of parameters and command blocks, and YS302-YS306, YS401-YS404, YS905's code.
#include <algorithm>

#include "decoder/findings/catalogue.hpp"
#include "decoder/profiles/yaskawa_ns310/derived.hpp"
#include "decoder/profiles/yaskawa_ns310/session.hpp"

namespace servotrace::ns310 {
namespace {

constexpr std::uint16_t kIdentity = 0x01;
constexpr std::uint16_t kSupervisor = 0x24;
constexpr std::uint16_t kController = 0x25;
constexpr std::uint16_t kSequencer = 0x26;
constexpr std::uint16_t kCommandBlock = 0x27;
constexpr std::uint16_t kControlParameter = 0x64;
constexpr std::uint16_t kServopackParameter = 0x66;
constexpr std::uint8_t kGetAll = 0x01;
constexpr std::uint8_t kSetAll = 0x02;
constexpr std::uint8_t kReset = 0x05;
constexpr std::uint8_t kGet = 0x0E;
constexpr std::uint8_t kSet = 0x10;

// Table 4.29: rows filter 0 to 3, bit n: acceleration type n.
constexpr std::uint8_t kLegalPairs[] = {0b1111, 0b0001, 0b0001, 0b1011};
// Table 4.38: profile type, acceleration type (64h/56 and 65), filter (64h/58).
struct ProfileRow {
  std::int64_t profile;
  std::int64_t acceleration;
  std::int64_t filter;
};
constexpr ProfileRow kProfileRows[] = {{0, 3, 0},   {1, 3, 3},   {2, 0, 1},   {240, 1, 0}, {241, 2, 0},
                                       {242, 0, 2}, {243, 0, 3}, {244, 1, 3}, {245, 0, 0}};

std::int64_t value_of(Bytes data) {
  const auto size = static_cast<unsigned>(data.size() < 4 ? data.size() : 4);
  const std::uint32_t raw = load_le(data, 0, size);
  return size == 4 ? static_cast<std::int32_t>(raw) : static_cast<std::int64_t>(raw);
}

// Attributes kept in the flash ROM at the next start (4.1.3): parameters, not commands and states.
bool is_flash_parameter(std::uint16_t class_id, std::int32_t attribute) {
  if (class_id == kControlParameter || class_id == kServopackParameter) return true;
  if (class_id == kSupervisor) return attribute != 12;
  if (class_id != kController) return false;
  switch (attribute) {
    case 3:
    case 6:
    case 7:
    case 8:
    case 9:
    case 10:
    case 11:
    case 13:
    case 17:
    case 20:
    case 21:
    case 22:
    case 23:
    case 47:
      return false;
    default:
      return true;
  }
}

// Tables 5.4 and 5.6 to 5.10: what a block may change or compare. 13 and 15 are printed 0x13 and 0x15: both are taken.
bool is_block_target(std::uint8_t command, std::int64_t class_id, std::int64_t instance, std::int64_t attribute) {
  if (instance != 1) return false;
  if (command == static_cast<std::uint8_t>(BlockCommand::kModifyAttribute)) {
    return (class_id == kController && (attribute == 8 || attribute == 9)) ||
           (class_id == kControlParameter && (attribute == 52 || attribute == 53));
  }
  return class_id == kController && (attribute == 13 || attribute == 15 || attribute == 19 || attribute == 21);
}

}  // namespace

void Session::on_explicit(const Context& context, const ExplicitExchange& exchange) {
  expire(context);
  waits_ = true;
  const bool sets = exchange.service == kSet || exchange.service == kSetAll;
  if (!exchange.is_response) {
    if (exchange.class_id == kIdentity && exchange.service == kReset) judge_pairs(context);
    if (exchange.class_id == kCommandBlock && sets) judge_block_request(context, exchange);
    if (exchange.class_id == kSequencer && exchange.service == kSet) judge_sequencer_start(context, exchange);
    return;
  }
  if (exchange.is_error) return;
  if (exchange.class_id == kCommandBlock) {
    learn_block(context, exchange);
    return;
  }
  if (exchange.service != kSet && exchange.service != kGet) return;
  const bool written = exchange.service == kSet;
  const Bytes data = written ? exchange.request_data : exchange.response.bytes;
  if (data.empty() || exchange.instance != 1) return;
  learn_parameter(context, exchange, value_of(data), written);
}

void Session::learn_parameter(const Context& context, const ExplicitExchange& exchange, std::int64_t value,
                              bool written) {
  const std::uint16_t class_id = exchange.class_id;
  const std::int32_t attribute = exchange.attribute;
  const Basis basis{BasisKind::kCapture, context.frame.number};
  const auto learn = [&](Setting& setting) {
    setting = {value, basis};
    if (written) {
      settle_ns_ = context.frame.time_ns;
      settle_pending_ = true;
    }
  };
  if (written && is_flash_parameter(class_id, attribute)) flash_dirty_ = true;
  const bool by_reset = (class_id == kSupervisor && attribute == 11) || (class_id == kController && attribute == 24) ||
                        (class_id == kControlParameter && (attribute == 30 || attribute == 31));
  if (written && by_reset) {
    needs_reset_ = {true, class_id, attribute, exchange.request_frame};
  }
  if (class_id == kController && attribute == 24) {
    // A written value acts after a reset; a read one after a write shows that value, not the one in force.
    if (!written && !(needs_reset_.active && needs_reset_.class_id == kController)) {
      reference_direction_ = {value, basis};
    } else {
      written_direction_ = {value, basis};
    }
  }
  if (class_id == kController && attribute == 18) {
    for (const ProfileRow& row : kProfileRows) {
      if (row.profile != value) continue;
      acceleration_ = {row.acceleration, basis};
      jog_acceleration_ = {row.acceleration, basis};
      filter_ = {row.filter, basis};
    }
  }
  if (class_id == kSequencer && attribute == 1) sequencer_block_ = static_cast<std::uint8_t>(value);
  if (class_id == kSequencer && attribute == 5 && !written && pending_block_fault_.active) {
    issue_block_fault(context, value);
  }
  if (class_id != kControlParameter) return;
  if (attribute == 30) learn(gear_numerator_);
  if (attribute == 31) learn(gear_denominator_);
  if (attribute == 56) learn(acceleration_);
  if (attribute == 58) learn(filter_);
  if (attribute == 65) learn(jog_acceleration_);
}

// YS401 and YS402: at a start or a Reset, or a second after the last Set, when all of a change has arrived.
void Session::judge_pairs(const Context& context) {
  settle_pending_ = false;
  if (gear_numerator_.is_known() && gear_denominator_.is_known()) {
    // Both readings of their range: signed, or all 32 bits.
    const auto numerator = static_cast<std::int64_t>(static_cast<std::uint32_t>(gear_numerator_.value));
    const auto denominator = static_cast<std::int64_t>(static_cast<std::uint32_t>(gear_denominator_.value));
    const bool bad = denominator == 0 || std::max(numerator, denominator) > 100 * std::min(numerator, denominator);
    judge(context, bad,
          {.rule = rule("YS401"),
           .arguments = {numerator, denominator},
           .related = {gear_numerator_.basis.frame, gear_denominator_.basis.frame},
           .basis = gear_denominator_.basis,
           .variant = numerator << 32U ^ denominator});
  }
  if (!filter_.is_known()) return;
  const auto illegal = [&](const Setting& type) {
    return type.is_known() && filter_.value >= 0 && filter_.value <= 3 && type.value >= 0 && type.value <= 3 &&
           (kLegalPairs[filter_.value] >> type.value & 1U) == 0;
  };
  const bool positioning = illegal(acceleration_);
  const bool jog = illegal(jog_acceleration_);
  const Setting& bad = positioning ? acceleration_ : jog_acceleration_;
  judge(context, positioning || jog,
        {.rule = rule("YS402"),
         .arguments = {positioning ? 56 : 65, bad.value, filter_.value},
         .related = {bad.basis.frame, filter_.basis.frame},
         .basis = filter_.basis,
         .variant = (positioning ? 0 : 16) + bad.value * 4 + filter_.value});
}

// What a start of any motion shows of the parameters set before it.
void Session::judge_parameters_at_start(const Context& context, ByteRange where) {
  if (settle_pending_) judge_pairs(context);
  checked(context, rule("YS403"));
  if (needs_reset_.active) {
    raise(context, {.rule = rule("YS403"),
                    .arguments = {needs_reset_.class_id, needs_reset_.attribute},
                    .where = where,
                    .related = {needs_reset_.frame}});
    needs_reset_.active = false;
  }
  if (flash_dirty_) {
    flash_dirty_ = false;
    const bool often = flash_starts_.add(context.frame.time_ns);
    judge(context, often, {.rule = rule("YS404"), .arguments = {limits().flash_writes_per_hour}, .where = where});
  }
}

// A Set of a command block, before the drive's answer.
void Session::judge_block_request(const Context& context, const ExplicitExchange& exchange) {
  const ByteRange where = exchange.request.in_frame;
  if (response_) {
    checked(context, rule("YS302"));
    if (response_->block_in_execution || response_->alarm) {
      raise(context, {.rule = rule("YS302"),
                      .arguments = {exchange.instance, response_->alarm ? 1 : 0},
                      .where = where,
                      .related = {response_->frame}});
    }
  }
  if (exchange.instance == 0 || exchange.instance > 255) return;
  Block block = blocks_.at(static_cast<std::uint8_t>(exchange.instance));
  const bool all = exchange.service == kSetAll;
  const auto attribute = static_cast<unsigned>(exchange.attribute < 0 ? 0 : exchange.attribute);
  if (all) {
    if (!Blocks::set_all(block, exchange.request_data, context.frame.number)) return;
    show_block(context, exchange.request, block, Direction::kCommand);
  } else {
    Blocks::set(block, attribute, exchange.request_data, true, context.frame.number);
    show_block_attribute(context, exchange, block, exchange.request_data);
  }
  if (!all && attribute < 3) return;
  const std::int32_t* class_id = block.find(BlockValue::kClass);
  const std::int32_t* instance = block.find(BlockValue::kInstance);
  const std::int32_t* number = block.find(BlockValue::kAttribute);
  // Set one by one, they are whole only when none of them is still 0.
  if ((all || attribute <= 5) && class_id != nullptr && instance != nullptr && number != nullptr &&
      (all || (*class_id != 0 && *instance != 0 && *number != 0))) {
    checked(context, rule("YS305"));
    if (!is_block_target(block.command, *class_id, *instance, *number)) {
      raise(
          context,
          {.rule = rule("YS305"), .arguments = {exchange.instance, block.command, *class_id, *number}, .where = where});
    }
  }
  const std::int32_t* delay = block.find(BlockValue::kDelay);
  if (delay != nullptr && (all || attribute == 3)) {
    checked(context, rule("YS306"));
    if (*delay % 8 != 0) {
      raise(context, {.rule = rule("YS306"), .arguments = {exchange.instance, *delay}, .where = where});
    }
  }
}

// A whole block, where the message has the length of its format.
void Session::show_block(const Context& context, const Message& message, const Block& block,
                         Direction direction) const {
  const BlockFormat* format = block.format();
  if (format == nullptr) return;
  const Layout& layout = kBlockLayouts[static_cast<std::size_t>(format - kBlockFormats.data())];
  if (message.bytes.size() == layout.size) add(context, message, layout, 0, direction);
}

// "Target Position 3000 steps": attributes 3 to 7 mean what the block's command says.
void Session::show_block_attribute(const Context& context, const ExplicitExchange& exchange, const Block& block,
                                   Bytes data) {
  const BlockFormat* format = block.format();
  if (context.dissection == nullptr || format == nullptr || data.empty() || exchange.attribute < 3) return;
  const auto index = static_cast<std::size_t>(exchange.attribute) - 3;
  if (index >= format->count) return;
  const BlockAttribute& row = *format->attributes[index];
  attribute_text_.clear();
  attribute_text_ << row.name << " " << value_of(data);
  if (row.unit != Unit::kNone) attribute_text_ << " " << symbol(row.unit);
  add(context, kBlockAttribute, "ns310", 0, attribute_text_.view());
}

void Session::learn_block(const Context& context, const ExplicitExchange& exchange) {
  if (exchange.instance == 0 || exchange.instance > 255) return;
  const auto number = static_cast<std::uint8_t>(exchange.instance);
  Block& block = blocks_.mutable_at(number);
  const std::uint64_t frame = context.frame.number;
  const auto attribute = static_cast<unsigned>(exchange.attribute < 0 ? 0 : exchange.attribute);
  switch (exchange.service) {
    case kSet:
      Blocks::set(block, attribute, exchange.request_data, true, frame);
      break;
    case kSetAll:
      Blocks::set_all(block, exchange.request_data, frame);
      break;
    case kGet:
      Blocks::set(block, attribute, exchange.response.bytes, false, frame);
      show_block_attribute(context, exchange, block, exchange.response.bytes);
      break;
    case kGetAll: {
      const Block before = block;
      Blocks::set_all(block, exchange.response.bytes, frame);
      if (before.set_singly && before.command == block.command) {  // reading writes nothing
        block.set_singly = true;
        block.written = before.written;
      }
      show_block(context, exchange.response, block, Direction::kResponse);
      break;
    }
    default:
      return;
  }
  if (context.dissection == nullptr) return;
  text_.clear();
  append_block(text_, number, block);
  add(context, kBlockListing, "ns310", 0, text_.view());
}

// A Set of 26h/2 starts the chain that 26h/1 names (B.8). YS104 and YS301 are of the bit Start_Block: what 5.3.3 says
// of the servo, it says of the command assembly, and a block 0 is outside the range of 26h/1 (DN403).
void Session::judge_sequencer_start(const Context& context, const ExplicitExchange& exchange) {
  if (exchange.attribute != 2 || exchange.request_data.empty() || value_of(exchange.request_data) == 0) return;
  const ByteRange where = exchange.request.in_frame;
  judge_parameters_at_start(context, where);
  homing_block_ = 0;
  if (sequencer_block_ && *sequencer_block_ != 0) judge_chain(context, *sequencer_block_, where);
}

// A start of command blocks: what is wrong with the chain from `first` on.
void Session::judge_chain(const Context& context, std::uint8_t first, ByteRange where) {
  checked(context, rule("YS303"));
  checked(context, rule("YS304"));
  if (const auto fault = blocks_.half_written(first); fault.kind != Blocks::Fault::Kind::kNone) {
    raise(context, {.rule = rule("YS303"),
                    .arguments = {fault.block, static_cast<std::int64_t>(fault.attribute)},
                    .where = where,
                    .related = {fault.frame}});
  }
  if (const auto fault = blocks_.chain_fault(first); fault.kind != Blocks::Fault::Kind::kNone) {
    const bool empty = fault.kind == Blocks::Fault::Kind::kEmpty;
    raise(context, {.rule = rule("YS304"),
                    .arguments = {first, fault.block, empty ? 0 : 1},
                    .where = where,
                    .related = {fault.frame},
                    .as_error = empty});
  }
  if (context.dissection == nullptr) return;
  text_.clear();
  append_chain(text_, blocks_, first);
  add(context, kBlockListing, "ns310", 0, text_.view());
}

}  // namespace servotrace::ns310
