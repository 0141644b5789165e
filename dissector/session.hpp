// SPDX-License-Identifier: GPL-2.0-or-later
// The file Wireshark has open: one pipeline, fed with every frame once and in file order, and what it said of each.
#pragma once

#include <span>

#include "decoder/findings/finding.hpp"
#include "decoder/pipeline/dissection.hpp"
#include "decoder/pipeline/settings.hpp"
#include "dissector/store.hpp"
#include "dissector/ws.hpp"

namespace servotrace::plugin {

// A frame as the pipeline saw it. Valid until the next call of visit().
struct Visit {
  const Dissection* dissection = nullptr;  // never nullptr
  std::span<const Finding> findings;       // of this frame, also those no plugin shows
  tvbuff_t* tvb = nullptr;                 // the whole frame; nullptr where Wireshark has none
  std::uint32_t number = 0;
  std::uint32_t shape = FrameStore::kNoShape;  // the same for frames that look alike
};

// Pushes the frame into the pipeline where this is its first visit, and draws on what is kept where it is not. Every
// entry of the plugin calls it, in any order: the frame is pushed once.
Visit visit(packet_info* pinfo);

// Frames that answer frame `number`.
std::span<const FrameStore::Answer> answers_of(std::uint32_t number);
// The next frame of the same node and direction, which names `number` as the one before it; frame 0: none.
struct NextOfNode {
  std::uint32_t frame = 0;
  NodeRef node;
};
NextOfNode next_of_node(std::uint32_t number);

// "ring0"; a CAN bus by its interface's name, else can<N> in the order of appearance. Lives as long as the file.
const char* bus_text(const BusRef& bus);

// What the file is dissected with; nullptr before its first frame.
const Settings* session_settings();
// Changes the severity of a finding where the settings say so. False where it is not shown: the settings hide it, or
// its rule needs the whole file.
bool shown_finding(Finding& finding);

// A new file, or the same once more with other settings: what is known is forgotten.
void reset_session();

}  // namespace servotrace::plugin
