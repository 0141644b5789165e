/* SPDX-License-Identifier: MIT
 *
 * Records RTEX traffic from inside a host controller: each communication cycle, the transmission memory (command
 * blocks) and the reception memory (response blocks) of the communication ASIC become one record each, in a pcapng
 * stream that Wireshark (with the servotrace plugin) and servotrace open with no setting.
 *
 * C99, one header, no library, no allocation; each call takes constant time: it copies at most 512 bytes and calls your
 * write function once. The page README.md beside this file shows how to call it from a cyclic task.
 *
 *   struct servotrace_rtex_recorder recorder;
 *   struct servotrace_rtex_config config = {0};
 *   config.write = put_into_my_ring_buffer;
 *   config.node_count = 2;
 *   config.cycle_ns = 500000;
 *   servotrace_rtex_open(&recorder, &config);
 *   each cycle n:
 *     servotrace_rtex_command(&recorder, now_ns, n, transmission_memory);
 *     servotrace_rtex_response(&recorder, now_ns, n, reception_memory);
 */
#ifndef SERVOTRACE_RTEX_RECORDER_H
#define SERVOTRACE_RTEX_RECORDER_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#endif
extern "C" {
#endif

#define SERVOTRACE_RTEX_HEADER_SIZE 24u  /* bytes of a record header, format version 1 */
#define SERVOTRACE_RTEX_MEMORY_SIZE 512u /* bytes of each of the ASIC's memories: 32 blocks of 16 */
#define SERVOTRACE_RTEX_RECORD_SIZE (SERVOTRACE_RTEX_HEADER_SIZE + SERVOTRACE_RTEX_MEMORY_SIZE)
/* Around a record in the file: the packet block's fields, the exported PDU tags, the length again. */
#define SERVOTRACE_RTEX_PACKET_SIZE (28u + 12u + SERVOTRACE_RTEX_RECORD_SIZE + 4u)

/* Takes `size` bytes in order. Returns 0, or another number where they could not be taken: the call that wrote them
 * then returns that number, and nothing of them may have been kept. */
typedef int (*servotrace_rtex_write)(void* context, const void* bytes, size_t size);

struct servotrace_rtex_config {
  servotrace_rtex_write write;
  void* context;       /* handed to write */
  uint8_t ring;        /* which ring of this controller, 0 for the first */
  uint8_t node_count;  /* 1 to 32, in connection order */
  uint32_t wide_nodes; /* bit i: node i is in 32-byte mode and has two blocks */
  uint32_t cycle_ns;   /* configured communication cycle: 83333, 166667, 500000, 1000000; 0: not known */
  int sampled;         /* not 0: the recorder polls and does not take every cycle */
};

struct servotrace_rtex_recorder {
  struct servotrace_rtex_config config;
  size_t memory_size; /* bytes of the blocks in use */
  uint8_t packet[SERVOTRACE_RTEX_PACKET_SIZE];
};

enum {
  SERVOTRACE_RTEX_OK = 0,
  SERVOTRACE_RTEX_BAD_CONFIG = -1 /* no write function, no node, more nodes or blocks than 32 */
};

static inline void servotrace_rtex_put16(uint8_t* at, uint16_t value) {
  at[0] = (uint8_t)value;
  at[1] = (uint8_t)(value >> 8);
}

static inline void servotrace_rtex_put32(uint8_t* at, uint32_t value) {
  servotrace_rtex_put16(at, (uint16_t)value);
  servotrace_rtex_put16(at + 2, (uint16_t)(value >> 16));
}

/* Bytes of each memory the nodes use, or 0 where the configuration is impossible. */
static inline size_t servotrace_rtex_memory_size(const struct servotrace_rtex_config* config) {
  unsigned blocks = 0;
  unsigned node;
  if (config->node_count == 0 || config->node_count > 32) return 0;
  for (node = 0; node < config->node_count; ++node) blocks += 1u + (unsigned)(config->wide_nodes >> node & 1u);
  return blocks > 32 ? 0 : (size_t)blocks * 16u;
}

/* Makes one record in `out` (at least SERVOTRACE_RTEX_RECORD_SIZE bytes): what goes into a UDP datagram to port 35224,
 * or behind EtherType 88B5h, to mirror cycles instead of writing a file. `memory` holds the blocks in connection order.
 * Returns the record's length, or 0 where the configuration is impossible. */
static inline size_t servotrace_rtex_record(const struct servotrace_rtex_config* config, int is_response,
                                            uint32_t sequence, const void* memory, uint8_t* out) {
  const size_t size = servotrace_rtex_memory_size(config);
  if (size == 0) return 0;
  memset(out, 0, SERVOTRACE_RTEX_HEADER_SIZE);
  memcpy(out, "RTEX", 4);
  out[4] = 1; /* version */
  out[5] = SERVOTRACE_RTEX_HEADER_SIZE;
  out[6] = (uint8_t)((is_response ? 1u : 0u) | 2u | (config->cycle_ns != 0 ? 4u : 0u) | (config->sampled ? 8u : 0u));
  out[7] = config->ring;
  servotrace_rtex_put32(out + 8, sequence);
  servotrace_rtex_put32(out + 12, config->cycle_ns);
  servotrace_rtex_put32(out + 16, config->wide_nodes);
  out[20] = config->node_count;
  memcpy(out + SERVOTRACE_RTEX_HEADER_SIZE, memory, size);
  return SERVOTRACE_RTEX_HEADER_SIZE + size;
}

/* Begins the stream: section header and interface. */
static inline int servotrace_rtex_open(struct servotrace_rtex_recorder* recorder,
                                       const struct servotrace_rtex_config* config) {
  uint8_t head[28 + 32];
  recorder->config = *config;
  recorder->memory_size = servotrace_rtex_memory_size(config);
  if (recorder->memory_size == 0 || config->write == NULL) return SERVOTRACE_RTEX_BAD_CONFIG;
  memset(head, 0, sizeof head);
  servotrace_rtex_put32(head, 0x0A0D0D0Au); /* section header block */
  servotrace_rtex_put32(head + 4, 28);
  servotrace_rtex_put32(head + 8, 0x1A2B3C4Du); /* least significant byte first */
  servotrace_rtex_put16(head + 12, 1);          /* version 1.0 */
  memset(head + 16, 0xFF, 8);                   /* section length not known */
  servotrace_rtex_put32(head + 24, 28);
  servotrace_rtex_put32(head + 28, 1); /* interface description block */
  servotrace_rtex_put32(head + 32, 32);
  servotrace_rtex_put16(head + 36, 252); /* LINKTYPE_WIRESHARK_UPPER_PDU */
  servotrace_rtex_put16(head + 44, 9);   /* if_tsresol: */
  servotrace_rtex_put16(head + 46, 1);
  head[48] = 9; /* nanoseconds; then the end of the options */
  servotrace_rtex_put32(head + 56, 32);
  return config->write(config->context, head, sizeof head);
}

static inline int servotrace_rtex_append(struct servotrace_rtex_recorder* recorder, int is_response, uint64_t time_ns,
                                         uint32_t sequence, const void* memory) {
  uint8_t* const packet = recorder->packet;
  /* A record's length is a multiple of 4 as its parts are: no padding. */
  const uint32_t captured = (uint32_t)(12u + SERVOTRACE_RTEX_HEADER_SIZE + recorder->memory_size);
  const uint32_t total = 28u + captured + 4u;
  servotrace_rtex_put32(packet, 6); /* enhanced packet block */
  servotrace_rtex_put32(packet + 4, total);
  servotrace_rtex_put32(packet + 8, 0); /* interface */
  servotrace_rtex_put32(packet + 12, (uint32_t)(time_ns >> 32));
  servotrace_rtex_put32(packet + 16, (uint32_t)time_ns);
  servotrace_rtex_put32(packet + 20, captured);
  servotrace_rtex_put32(packet + 24, captured);
  /* Exported PDU tags, most significant byte first: 12 (dissector name) "rtex", then 0 (end). */
  memcpy(packet + 28, "\0\014\0\004rtex\0\0\0\0", 12);
  (void)servotrace_rtex_record(&recorder->config, is_response, sequence, memory, packet + 40);
  servotrace_rtex_put32(packet + total - 4, total);
  return recorder->config.write(recorder->config.context, packet, total);
}

/* The transmission memory, when the master has written it for cycle `sequence`. `time_ns`: since 1970-01-01 UTC. */
static inline int servotrace_rtex_command(struct servotrace_rtex_recorder* recorder, uint64_t time_ns,
                                          uint32_t sequence, const void* transmission_memory) {
  return servotrace_rtex_append(recorder, 0, time_ns, sequence, transmission_memory);
}

/* The reception memory, when the master has read it in cycle `sequence`. After the command of the same cycle. */
static inline int servotrace_rtex_response(struct servotrace_rtex_recorder* recorder, uint64_t time_ns,
                                           uint32_t sequence, const void* reception_memory) {
  return servotrace_rtex_append(recorder, 1, time_ns, sequence, reception_memory);
}

/* Records that were thrown away because your buffer was full, counted since the start: an interface statistics block.
 * Readers then know that a gap is the recorder's. */
static inline int servotrace_rtex_dropped(struct servotrace_rtex_recorder* recorder, uint64_t time_ns,
                                          uint64_t dropped) {
  uint8_t block[40];
  memset(block, 0, sizeof block);
  servotrace_rtex_put32(block, 5); /* interface statistics block */
  servotrace_rtex_put32(block + 4, 40);
  servotrace_rtex_put32(block + 12, (uint32_t)(time_ns >> 32));
  servotrace_rtex_put32(block + 16, (uint32_t)time_ns);
  servotrace_rtex_put16(block + 20, 5); /* isb_ifdrop */
  servotrace_rtex_put16(block + 22, 8);
  servotrace_rtex_put32(block + 24, (uint32_t)dropped);
  servotrace_rtex_put32(block + 28, (uint32_t)(dropped >> 32));
  servotrace_rtex_put32(block + 36, 40);
  return recorder->config.write(recorder->config.context, block, sizeof block);
}

#ifdef __cplusplus
}
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
#endif

#endif
