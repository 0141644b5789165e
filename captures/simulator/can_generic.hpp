// SPDX-License-Identifier: MIT
// A slave of no known maker: its poll data come back as they were sent, its own objects are a plain input and output.
#pragma once

#include "captures/simulator/can_slave.hpp"

namespace servotrace::simulator {

class GenericSlave : public Slave {
 public:
  GenericSlave(CanBus& bus, Settings settings) : Slave(bus, std::move(settings)) {
    data_.resize(this->settings().response_size);
  }

 protected:
  void take_command(Bytes command) override {
    for (std::size_t i = 0; i < data_.size(); ++i) data_[i] = i < command.size() ? command[i] : std::uint8_t{0};
  }
  ByteVector make_response() override { return data_; }
  ExplicitReply serve(const ExplicitRequest&) override { return ExplicitReply::error(status::kObjectDoesNotExist); }

 private:
  ByteVector data_;
};

}  // namespace servotrace::simulator
