/* SPDX-License-Identifier: MIT
 *
 * Records a make-believe ring of two axes: the cyclic task puts records into a ring buffer, the idle task writes it to
 * a file. usage: servotrace_rtex_recorder_example FILE.pcapng [CYCLES]
 */
#include <stdio.h>
#include <stdlib.h>

#include "servotrace_rtex_recorder.h"

/* --- A buffer between the cyclic task (one writer) and the idle task (one reader). On a target with two cores make
 * `written` and `taken` atomic, or put a memory barrier where the comments say. --- */
#define BUFFER_SIZE 65536u /* a power of two */

struct buffer {
  uint8_t bytes[BUFFER_SIZE];
  size_t written; /* both only ever grow */
  size_t taken;
};

static int put(void* context, const void* bytes, size_t size) {
  struct buffer* buffer = context;
  const uint8_t* from = bytes;
  size_t i;
  if (size > BUFFER_SIZE - (buffer->written - buffer->taken)) return 1; /* full: this record is lost, whole */
  for (i = 0; i < size; ++i) buffer->bytes[(buffer->written + i) % BUFFER_SIZE] = from[i];
  buffer->written += size; /* barrier before this line */
  return 0;
}

static int drain(struct buffer* buffer, FILE* file) {
  while (buffer->taken != buffer->written) {
    const size_t at = buffer->taken % BUFFER_SIZE;
    size_t size = buffer->written - buffer->taken;
    if (size > BUFFER_SIZE - at) size = BUFFER_SIZE - at;
    if (fwrite(buffer->bytes + at, 1, size, file) != size) return 1;
    buffer->taken += size; /* barrier before this line */
  }
  return 0;
}

/* --- What a real controller does through the ASIC: here both axes stand in cyclic position mode. --- */
#define AXES 2u
#define NOP_CYCLES 20u

struct ring {
  uint8_t transmission[AXES * 16u];
  uint8_t reception[AXES * 16u];
  uint8_t counter_before; /* Update_Counter of the cycle before */
  uint8_t code_before[2]; /* command codes of the two cycles before */
};

static void run_cycle(struct ring* ring, uint32_t cycle) {
  const uint8_t counter = (uint8_t)(cycle < NOP_CYCLES ? 0u : (cycle - NOP_CYCLES + 1u) % 4u);
  const uint8_t code = cycle < NOP_CYCLES ? 0x00 : 0x20;
  unsigned axis;
  memset(ring->transmission, 0, sizeof ring->transmission);
  memset(ring->reception, 0, sizeof ring->reception);
  for (axis = 0; axis < AXES; ++axis) {
    uint8_t* const command = ring->transmission + 16u * axis;
    uint8_t* const response = ring->reception + 16u * axis;
    command[0] = (uint8_t)((unsigned)counter << 5 | (axis + 1u));
    command[1] = code;
    response[0] = (uint8_t)(0x80u | (unsigned)ring->counter_before << 5 | (axis + 1u));
    response[1] = ring->code_before[1];
    response[2] = cycle < NOP_CYCLES + 8u ? 0x01 : 0x41; /* In_Position, later Servo_Ready, too */
  }
  ring->counter_before = counter;
  ring->code_before[1] = ring->code_before[0];
  ring->code_before[0] = code;
}

int main(int argc, char** argv) {
  static struct buffer buffer;
  static struct servotrace_rtex_recorder recorder;
  struct servotrace_rtex_config config = {0};
  struct ring ring = {0};
  const uint32_t cycles = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 200u;
  uint64_t dropped = 0;
  uint64_t time_ns = 1767600000u * UINT64_C(1000000000); /* a controller takes its clock */
  uint32_t cycle;
  FILE* file;
  if (argc < 2) {
    fprintf(stderr, "usage: %s FILE.pcapng [CYCLES]\n", argv[0]);
    return 2;
  }
  file = fopen(argv[1], "wb");
  if (file == NULL) {
    perror(argv[1]);
    return 2;
  }
  config.write = put;
  config.context = &buffer;
  config.node_count = AXES;
  config.cycle_ns = 500000;
  if (servotrace_rtex_open(&recorder, &config) != 0) {
    fclose(file);
    return 2;
  }
  for (cycle = 0; cycle < cycles; ++cycle) {
    /* the cyclic task */
    run_cycle(&ring, cycle);
    if (servotrace_rtex_command(&recorder, time_ns, cycle, ring.transmission) != 0) ++dropped;
    if (servotrace_rtex_response(&recorder, time_ns + 60000u, cycle, ring.reception) != 0) ++dropped;
    time_ns += config.cycle_ns;
    /* the idle task, now and then */
    if (cycle % 50u == 49u && drain(&buffer, file) != 0) break;
  }
  if (drain(&buffer, file) != 0) {
    perror(argv[1]);
    fclose(file);
    return 2;
  }
  if (dropped != 0 && (servotrace_rtex_dropped(&recorder, time_ns, dropped) != 0 || drain(&buffer, file) != 0)) {
    fclose(file);
    return 2;
  }
  if (fclose(file) != 0) {
    perror(argv[1]);
    return 2;
  }
  return 0;
}
