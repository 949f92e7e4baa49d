# Reads what limber's device and PC say to each other, in any language that Kaitai Struct compiles to.
# The regions between "begin" and "end" are made by tests/proto/proto_tables.c (PROTOCOL.md, "Changing it").
meta:
  id: limber
  title: limber frame body
  endian: le
  encoding: UTF-8
  ks-version: '0.10'
doc: |
  One frame with its COBS coding and its zeros taken off: header, payload, checksum.

  On the line a frame is 0x00, COBS(this), 0x00. To take the coding off: split the stream at zeros and drop
  empty stretches; then read a code byte c, copy the c - 1 bytes that follow, add a zero unless c was 0xFF or
  the stretch is over, and go on with the next code (Cheshire and Baker 1999; package cobs in Python).

  crc is CRC-32C (Castagnoli) of all bytes before it. Check it before anything else. A body must be
  used up by its type (_io.eof), else its length does not fit and the frame is to be dropped. A text has 96
  bytes at most.
doc-ref: PROTOCOL.md
seq:
  - id: header
    type: header
  - id: body
    size: _io.size - _io.pos - 4
    type:
      switch-on: header.type
      cases:
        # begin cases
        'message_type::hello': hello
        'message_type::ping': ping
        'message_type::pong': pong
        'message_type::timesync': timesync
        'message_type::timesync_answer': timesync_answer
        'message_type::heartbeat': heartbeat
        'message_type::stats_get': stats_get
        'message_type::stats': stats
        'message_type::log': log
        'message_type::rod_stats': rod_stats
        'message_type::pose': pose
        'message_type::angles': angles
        'message_type::nodes': nodes
        'message_type::pose_log': pose_log
        'message_type::touch': touch
        'message_type::arm': arm
        'message_type::disarm': disarm
        'message_type::estop': estop
        'message_type::clear_fault': clear_fault
        'message_type::reboot': reboot
        'message_type::param_list': param_list
        'message_type::param_get': param_get
        'message_type::param_set': param_set
        'message_type::param_commit': param_commit
        'message_type::param_save': param_save
        'message_type::param_defaults': param_defaults
        'message_type::preset_list': preset_list
        'message_type::preset': preset
        'message_type::servo_assign': servo_assign
        'message_type::servo_ping': servo_ping
        'message_type::servo_set_baud': servo_set_baud
        'message_type::servo_test': servo_test
        'message_type::scene_put': scene_put
        'message_type::scene_get': scene_get
        'message_type::shape': shape
        'message_type::ack': ack
        'message_type::nack': nack
        'message_type::param_info': param_info
        'message_type::param_value': param_value
        'message_type::preset_info': preset_info
        'message_type::fault': fault
        'message_type::boot_report': boot_report
        'message_type::servo_info': servo_info
        'message_type::scene_object': scene_object
        # end cases
  - id: crc
    type: u4
types:
  header:
    seq:
      - id: type
        type: u1
        enum: message_type
      - id: session
        type: u1
        doc: "chosen by the PC with each HELLO; 0 before the first"
      - id: seq
        type: u2
        doc: "counts this sender's frames of this type, wraps"
      - id: t_us
        type: u4
        doc: "sender's clock when the frame was made, wraps"
  angle_pair:
    seq:
      - {id: theta, type: s2}
      - {id: phi, type: s2}
    doc: "0.1 mrad; -32768: none"
  vector:
    seq:
      - {id: x, type: f4}
      - {id: y, type: f4}
      - {id: z, type: f4}
  # begin types
  hello:
    doc: "who is there; opens a session; both ways"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the PC; the device's answer repeats it; 0 unasked, after a start"
      - id: protocol_major
        type: u1
        doc: "another major is refused"
      - id: protocol_minor
        type: u1
        doc: "the lower of the two is spoken"
      - id: layout_hash
        type: u4
        doc: "messages_layout_hash: equal where both sides know the same messages"
      - id: features
        type: u4
        doc: "features the sender has"
      - id: links_max
        type: u2
        doc: "most links this build can have; 0 from the PC"
      - id: links_n
        type: u2
        doc: "links now; 0 from the PC"
      - id: tick_max_hz
        type: f4
        doc: "fastest tick; 0 from the PC"
      - id: tick_hz
        type: f4
        doc: "tick now; 0 from the PC"
      - id: angles_hz
        type: f4
        doc: "rate of ANGLES now; 0 from the PC"
      - id: pose_hz
        type: f4
        doc: "rate of POSE the PC is going to send, 0: none; 0 from the device"
      - id: line_baud
        type: u4
        doc: "0 where the line has no rate (USB, TCP, PTY); 0 from the PC"
      - id: device
        type: strz
        size: 16
        doc: "board, limber-sim, or the PC program"
      - id: build
        type: strz
        size: 24
        doc: "version and commit"
  ping:
    doc: "asks for a PONG; both ways"
    seq:
      - id: token
        type: u4
        doc: "anything"
  pong:
    doc: "answers a PING; both ways"
    seq:
      - id: token
        type: u4
        doc: "that of the PING"
  timesync:
    doc: "asks for the device's clock; to the device"
    seq:
      - id: t1_us
        type: u4
        doc: "PC's clock when this was sent"
      - id: last_known
        type: u1
        doc: "1: the four moments of the last exchange follow; 0: there was none"
      - id: last_t1_us
        type: u4
        doc: "PC's clock: the last TIMESYNC was sent"
      - id: last_t2_us
        type: u4
        doc: "device's clock: it had come in"
      - id: last_t3_us
        type: u4
        doc: "device's clock: the answer was sent"
      - id: last_t4_us
        type: u4
        doc: "PC's clock: the answer had come in"
  timesync_answer:
    doc: "answers a TIMESYNC; from the device"
    seq:
      - id: t1_us
        type: u4
        doc: "that of the TIMESYNC"
      - id: t2_us
        type: u4
        doc: "device's clock when the TIMESYNC had come in"
      - id: t3_us
        type: u4
        doc: "device's clock when this was sent"
  heartbeat:
    doc: "10 Hz, sent by the control loop itself; from the device"
    seq:
      - id: state
        type: u1
        enum: device_state
        doc: "device state"
      - id: fault
        type: u1
        enum: fault_code
        doc: "fault code latched, 0: none"
      - id: flags
        type: u1
        doc: "heartbeat flags"
      - id: uptime_ms
        type: u4
        doc: "since start, wraps after 49 days"
      - id: tick
        type: u4
        doc: "number of the last tick since start"
      - id: params_generation
        type: u4
        doc: "counts the changes of what is in force since start"
      - id: tick_mean_us
        type: u2
        doc: "time a tick took, mean since the last heartbeat"
      - id: tick_max_us
        type: u2
        doc: "the same, longest"
  stats_get:
    doc: "asks for STATS at once; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
  stats:
    doc: "every counter; at 1 Hz and when asked for; from the device"
    seq:
      - id: request_id
        type: u2
        doc: "that of the STATS_GET; 0 unasked"
      - id: uptime_ms
        type: u4
        doc: "since start; all counters below count from there and wrap"
      - id: frames_good
        type: u4
        doc: "frames whole and with the right checksum"
      - id: frames_crc
        type: u4
        doc: "frames with a wrong checksum"
      - id: frames_cobs
        type: u4
        doc: "frames cut off"
      - id: frames_too_short
        type: u4
        doc: "less than a header and a checksum between two zeros"
      - id: frames_too_long
        type: u4
        doc: "more than the longest frame between two zeros"
      - id: messages_unknown
        type: u4
        doc: "good frames of a type this build does not know or take"
      - id: messages_length
        type: u4
        doc: "good frames whose length does not fit their type"
      - id: poses_accepted
        type: u4
        doc: "poses used or replaced by a newer one before the tick"
      - id: poses_duplicate
        type: u4
        doc: "seq seen before"
      - id: poses_late
        type: u4
        doc: "seq before the newest one's, or captured no later than it"
      - id: poses_lost
        type: u4
        doc: "seqs passed over, less those that came late after all"
      - id: poses_wrong_session
        type: u4
        doc: "session is not that of the last HELLO"
      - id: poses_stale
        type: u4
        doc: "captured over 50 ms ago"
      - id: poses_future
        type: u4
        doc: "captured over 5 ms from now"
      - id: poses_not_finite
        type: u4
        doc: "NaN, infinity, or a coordinate beyond 500 m"
      - id: poses_bad_quaternion
        type: u4
        doc: "length of the quaternion is off 1 by over 0.01"
      - id: poses_teleport
        type: u4
        doc: "jumped"
      - id: poses_too_fast
        type: u4
        doc: "moved faster than a hand can"
      - id: commands_done
        type: u4
        doc: "requests answered by ACK or by what they asked for"
      - id: commands_refused
        type: u4
        doc: "requests answered by NACK"
      - id: commands_repeated
        type: u4
        doc: "requests seen before, answered again without being done again"
      - id: deadline_misses
        type: u4
        doc: "ticks that took longer than a tick"
      - id: solver_not_finite
        type: u4
        doc: "ticks without a finite answer"
      - id: limited_angle
        type: u4
        doc: "ticks in which a joint met its stop"
      - id: limited_acceleration
        type: u4
        doc: "ticks in which a joint met its bound of acceleration"
      - id: limited_rate
        type: u4
        doc: "ticks in which a joint met its bound of speed"
      - id: holds
        type: u4
        doc: "times HOLD was entered"
      - id: servo_errors
        type: u4
        doc: "errors servos reported"
      - id: line_overruns
        type: u4
        doc: "bytes lost on receipt for want of room"
      - id: line_framing
        type: u4
        doc: "bytes the UART received without a stop bit"
      - id: dropped_logs
        type: u4
        doc: "LOG not sent: the line was full"
      - id: dropped_telemetry
        type: u4
        doc: "STATS, POSE_LOG not sent: the line was full"
      - id: dropped_nodes
        type: u4
        doc: "NODES not sent: the line was full"
      - id: dropped_angles
        type: u4
        doc: "ANGLES not sent: the line was full"
      - id: answers_lost
        type: u4
        doc: "answers that found the queue full: the PC asks again"
      - id: clock_exchanges
        type: u4
        doc: "TIMESYNC exchanges used"
      - id: clock_left_out
        type: u4
        doc: "TIMESYNC exchanges too slow or impossible"
      - id: clock_jumps
        type: u4
        doc: "times one of the clocks was found to have jumped"
      - id: tick_max_us
        type: u4
        doc: "longest tick since start"
  log:
    doc: "a line for people; from the device"
    seq:
      - id: level
        type: u1
        enum: log_level
        doc: "log level"
      - {id: text, type: str, size-eos: true, terminator: 0}
  rod_stats:
    doc: "counters of the rod; just before each STATS; from the device"
    seq:
      - id: request_id
        type: u2
        doc: "that of the STATS_GET; 0 unasked"
      - id: lengths_restored
        type: u4
        doc: "elastic: ticks so violent that lengths were made good from the base outwards"
  pose:
    doc: "where the rod's base is; to the device"
    seq:
      - id: position_m
        type: f4
        repeat: expr
        repeat-expr: 3
        doc: "x y z of the base, world, right-handed"
      - id: quaternion_xyzw
        type: f4
        repeat: expr
        repeat-expr: 4
        doc: "base to world, of unit length; the straight rod runs along the base's +z"
      - id: age_us
        type: u2
        doc: "how long before the header's t_us the pose was captured; 65535: that or longer"
      - id: quality
        type: u1
        doc: "tracker's opinion, 0 worst ... 254 best, 255: it has none"
      - id: source
        type: u1
        enum: pose_source
        doc: "pose source"
  angles:
    doc: "the joint angles of a tick; from the device"
    seq:
      - id: tick
        type: u4
        doc: "number of the tick since start"
      - id: pose_seq
        type: u2
        doc: "seq of the newest POSE that went into it"
      - id: received_ago_us
        type: u2
        doc: "from receipt of that POSE to the header's t_us; 65535: that or longer"
      - id: solved_ago_us
        type: u2
        doc: "from the end of the solving to the header's t_us; 65535: that or longer"
      - id: state
        type: u1
        enum: device_state
        doc: "device state"
      - id: flags
        type: u1
        doc: "angles flags: which limit acted on any joint"
      - {id: angles_tenth_mrad, type: angle_pair, repeat: eos}
  nodes:
    doc: "where the link ends are, for graphics; from the device"
    seq:
      - id: tick
        type: u4
        doc: "number of the tick since start"
      - id: first_node
        type: u2
        doc: "which node the tail starts with; 0 is the base"
      - id: rod_nodes_n
        type: u2
        doc: "nodes of the whole rod: links + 1"
      - {id: nodes_m, type: vector, repeat: eos}
  pose_log:
    doc: "the exact base pose a tick used; from the device"
    seq:
      - id: tick
        type: u4
        doc: "number of the tick since start"
      - id: position_m
        type: f4
        repeat: expr
        repeat-expr: 3
        doc: "as given to the rod, every bit"
      - id: quaternion_xyzw
        type: f4
        repeat: expr
        repeat-expr: 4
        doc: "as given to the rod, every bit"
      - id: params_generation
        type: u4
        doc: "as in HEARTBEAT"
      - id: state
        type: u1
        enum: device_state
        doc: "device state"
      - id: flags
        type: u1
        doc: "pose log flags"
  touch:
    doc: "how hard objects push the rod; while any does; from the device"
    seq:
      - id: tick
        type: u4
        doc: "number of the tick since start"
      - id: contacts_n
        type: u2
        doc: "places where the rod touches: nodes, one that touches two objects counts twice"
      - id: force_newton
        type: f4
        repeat: expr
        repeat-expr: 3
        doc: "sum of what pushes the rod, in the world"
  arm:
    doc: "give the servos torque and start following; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
  disarm:
    doc: "stop following and take the torque away; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
  estop:
    doc: "torque off within one tick, latched; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
  clear_fault:
    doc: "leave FAULT or ESTOP for DISARMED; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
  reboot:
    doc: "start afresh; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
      - id: into
        type: u1
        enum: reboot_target
        doc: "reboot target"
  param_list:
    doc: "asks for a PARAM_INFO; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
      - id: index
        type: u2
        doc: "from 0; beyond the last one: NACK"
  param_get:
    doc: "asks for a PARAM_VALUE; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
      - id: which
        type: u1
        enum: parameter_set
        doc: "parameter set"
      - id: name
        type: strz
        size: 24
        doc: "of the parameter"
  param_set:
    doc: "stages values of one parameter; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
      - id: first
        type: u2
        doc: "entry that the first value is for, from 0; 0 where there is one entry"
      - id: name
        type: strz
        size: 24
        doc: "of the parameter"
      - {id: values, type: f4, repeat: eos}
  param_commit:
    doc: "checks and applies what is staged; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
  param_save:
    doc: "writes what is in force to flash; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
  param_defaults:
    doc: "stages every parameter's default; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
  preset_list:
    doc: "asks for a PRESET_INFO; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
      - id: index
        type: u2
        doc: "from 0; beyond the last one: NACK"
  preset:
    doc: "applies a preset, through a blend; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
      - id: name
        type: strz
        size: 24
        doc: "of the preset"
  servo_assign:
    doc: "gives a bus servo another id; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
      - id: old_id
        type: u1
        doc: "answers to this now; it must be the only one that does"
      - id: new_id
        type: u1
        doc: "shall answer to this from now on"
      - id: baud
        type: u4
        doc: "to talk to it at; 0: that of the servo_baud parameter"
  servo_ping:
    doc: "asks one servo for a SERVO_INFO; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
      - id: id
        type: u1
        doc: "of the servo, or a PWM channel from 1"
      - id: baud
        type: u4
        doc: "to talk to it at; 0: that of the servo_baud parameter"
  servo_set_baud:
    doc: "gives a bus servo another baud rate; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
      - id: id
        type: u1
        doc: "of the servo"
      - id: baud
        type: u4
        doc: "to talk to it at; 0: that of the servo_baud parameter"
      - id: new_baud
        type: u4
        doc: "shall talk at this from now on"
  servo_test:
    doc: "turns one servo a little and back; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
      - id: id
        type: u1
        doc: "of the servo, or a PWM channel from 1"
      - id: baud
        type: u4
        doc: "to talk to it at; 0: that of the servo_baud parameter"
      - id: turn_rad
        type: f4
        doc: "by so much, and back; at most 0.5 either way"
  scene_put:
    doc: "puts an object in place, or takes it away; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
      - id: index
        type: u1
        doc: "its place, from 0; 255 with kind 0: all of them"
      - id: kind
        type: u1
        enum: object_kind
        doc: "object kind; 0: the place is free, and the rest is 0 or ignored"
      - id: place_m
        type: f4
        repeat: expr
        repeat-expr: 3
        doc: "of its centre in the world, of a plane any point of its surface; within 1000 m"
      - id: orientation_xyzw
        type: f4
        repeat: expr
        repeat-expr: 4
        doc: "object to world, of unit length; a plane's free side is +z"
      - id: half_m
        type: f4
        repeat: expr
        repeat-expr: 3
        doc: "box: half its edges, less the radius; capsule: z, half its length, less the radius"
      - id: radius_m
        type: f4
        doc: "sphere, capsule; of a box what rounds its edges; 0.001 ... 1000, plane: 0"
      - id: friction
        type: f4
        doc: "Coulomb's coefficient between it and the rod, 0 ... 10"
  scene_get:
    doc: "asks for a SCENE_OBJECT; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
      - id: index
        type: u1
        doc: "from 0; beyond the last place: NACK"
  shape:
    doc: "pulls the joints to these angles, or lets them go; to the device"
    seq:
      - id: request_id
        type: u2
        doc: "chosen by the sender, not 0; the answer repeats it"
      - id: strength_nm
        type: f4
        doc: "like a spring of so many N m at each joint, 0 ... 1e6; 0: lets it go"
      - id: blend_s
        type: f4
        doc: "comes and goes within this time, 0 ... 60 s"
      - {id: angles_tenth_mrad, type: angle_pair, repeat: eos}
  ack:
    doc: "done; from the device"
    seq:
      - id: request_id
        type: u2
        doc: "that of the request"
      - id: answered
        type: u1
        doc: "type of the request"
  nack:
    doc: "not done, and why; from the device"
    seq:
      - id: request_id
        type: u2
        doc: "that of the request"
      - id: answered
        type: u1
        doc: "type of the request"
      - id: reason
        type: u1
        enum: reason
        doc: "reason"
      - id: entry
        type: s2
        doc: "joint or other entry of the field, from 0; -1: none in particular"
      - id: value
        type: f4
        doc: "what was given; this and the bounds are 0 where there is nothing to say"
      - id: minimum
        type: f4
        doc: "least allowed there"
      - id: maximum
        type: f4
        doc: "most allowed there"
      - id: field
        type: strz
        size: 24
        doc: "parameter or field at fault, empty: none in particular"
      - {id: text, type: str, size-eos: true, terminator: 0}
  param_info:
    doc: "what a parameter is; from the device"
    seq:
      - id: request_id
        type: u2
        doc: "that of the PARAM_LIST"
      - id: index
        type: u2
        doc: "that of the PARAM_LIST"
      - id: params_n
        type: u2
        doc: "how many parameters there are"
      - id: entries_n
        type: u2
        doc: "values it has now: 1, or one a joint or servo"
      - id: kind
        type: u1
        enum: parameter_kind
        doc: "parameter kind"
      - id: flags
        type: u1
        doc: "parameter flags"
      - id: minimum
        type: f4
        doc: "least allowed"
      - id: maximum
        type: f4
        doc: "most allowed"
      - id: initial
        type: f4
        doc: "default, of every entry"
      - id: name
        type: strz
        size: 24
        doc: "for people and requests"
      - id: unit
        type: strz
        size: 12
        doc: "empty: none"
      - {id: text, type: str, size-eos: true, terminator: 0}
  param_value:
    doc: "what a parameter is set to; from the device"
    seq:
      - id: request_id
        type: u2
        doc: "that of the PARAM_GET"
      - id: which
        type: u1
        enum: parameter_set
        doc: "parameter set"
      - id: name
        type: strz
        size: 24
        doc: "of the parameter"
      - {id: values, type: f4, repeat: eos}
  preset_info:
    doc: "what a preset is; from the device"
    seq:
      - id: request_id
        type: u2
        doc: "that of the PRESET_LIST"
      - id: index
        type: u2
        doc: "that of the PRESET_LIST"
      - id: presets_n
        type: u2
        doc: "how many presets there are"
      - id: name
        type: strz
        size: 24
        doc: "for people and requests"
      - {id: text, type: str, size-eos: true, terminator: 0}
  fault:
    doc: "the device stopped, and why; from the device"
    seq:
      - id: fault
        type: u1
        enum: fault_code
        doc: "fault code"
      - id: state
        type: u1
        enum: device_state
        doc: "device state it happened in"
      - id: tick
        type: u4
        doc: "number of the tick since start"
      - id: detail
        type: u4
        doc: "a number that tells more: servo, microseconds, address; depends on the fault"
      - {id: text, type: str, size-eos: true, terminator: 0}
  boot_report:
    doc: "how the device came up; follows its HELLO; from the device"
    seq:
      - id: cause
        type: u1
        enum: reset_cause
        doc: "reset cause"
      - id: fault
        type: u1
        enum: fault_code
        doc: "fault code that led to the reset, 0: none"
      - id: settings
        type: u1
        enum: settings_origin
        doc: "settings origin"
      - id: clock
        type: u1
        enum: clock_kind
        doc: "clock kind"
      - id: flags
        type: u1
        doc: "boot flags"
      - id: clock_hz
        type: u4
        doc: "of the core"
      - id: settings_sequence
        type: u4
        doc: "number of the settings record in use, 0: none"
      - id: pc
        type: u4
        doc: "where the processor was when it faulted; this and the next two are 0 else"
      - id: lr
        type: u4
        doc: "where it had been called from"
      - id: cfsr
        type: u4
        doc: "Cortex-M's configurable fault status"
  servo_info:
    doc: "how a servo is; from the device"
    seq:
      - id: request_id
        type: u2
        doc: "that of the SERVO_PING"
      - id: id
        type: u1
        doc: "of the servo"
      - id: firmware
        type: u1
        doc: "its version"
      - id: model
        type: u2
        doc: "its maker's number; 0 for a PWM channel"
      - id: baud
        type: u4
        doc: "it talks at"
      - id: hardware_error
        type: u1
        doc: "as it reports it: see its manual"
      - id: position_rad
        type: f4
        doc: "of its shaft, 0 in the middle of its travel"
      - id: supply_v
        type: f4
        doc: "volts it sees"
      - id: temperature_c
        type: f4
        doc: "degrees Celsius inside"
  scene_object:
    doc: "an object, and how hard it pushes the rod; from the device"
    seq:
      - id: request_id
        type: u2
        doc: "that of the SCENE_GET"
      - id: index
        type: u1
        doc: "that of the SCENE_GET"
      - id: objects_max
        type: u1
        doc: "how many places there are"
      - id: kind
        type: u1
        enum: object_kind
        doc: "object kind; 0: the place is free, and the rest is 0 or ignored"
      - id: place_m
        type: f4
        repeat: expr
        repeat-expr: 3
        doc: "of its centre in the world, of a plane any point of its surface; within 1000 m"
      - id: orientation_xyzw
        type: f4
        repeat: expr
        repeat-expr: 4
        doc: "object to world, of unit length; a plane's free side is +z"
      - id: half_m
        type: f4
        repeat: expr
        repeat-expr: 3
        doc: "box: half its edges, less the radius; capsule: z, half its length, less the radius"
      - id: radius_m
        type: f4
        doc: "sphere, capsule; of a box what rounds its edges; 0.001 ... 1000, plane: 0"
      - id: friction
        type: f4
        doc: "Coulomb's coefficient between it and the rod, 0 ... 10"
      - id: contacts_n
        type: u2
        doc: "nodes that touch it"
      - id: force_newton
        type: f4
        repeat: expr
        repeat-expr: 3
        doc: "sum of what it pushes the rod with, in the world"
  # end types
enums:
  # begin enums
  message_type:
    0x01: hello
    0x02: ping
    0x03: pong
    0x04: timesync
    0x05: timesync_answer
    0x06: heartbeat
    0x07: stats_get
    0x08: stats
    0x09: log
    0x0a: rod_stats
    0x10: pose
    0x11: angles
    0x12: nodes
    0x13: pose_log
    0x14: touch
    0x20: arm
    0x21: disarm
    0x22: estop
    0x23: clear_fault
    0x24: reboot
    0x30: param_list
    0x31: param_get
    0x32: param_set
    0x33: param_commit
    0x34: param_save
    0x35: param_defaults
    0x36: preset_list
    0x37: preset
    0x38: servo_assign
    0x39: servo_ping
    0x3a: servo_set_baud
    0x3b: servo_test
    0x3c: scene_put
    0x3d: scene_get
    0x3e: shape
    0x40: ack
    0x41: nack
    0x42: param_info
    0x43: param_value
    0x44: preset_info
    0x45: fault
    0x46: boot_report
    0x47: servo_info
    0x48: scene_object
  device_state:
    0:
      id: boot
      doc: "starting"
    1:
      id: selftest
      doc: "checking itself"
    2:
      id: disarmed
      doc: "servos without torque; settings may be saved"
    3:
      id: arming
      doc: "torque on, blending from where the servos are"
    4:
      id: active
      doc: "following the poses"
    5:
      id: hold
      doc: "poses stopped: angles are held"
    6:
      id: relax
      doc: "poses stayed away: going straight slowly"
    7:
      id: limp
      doc: "torque off after RELAX; ARM to go on"
    8:
      id: fault
      doc: "torque off, latched: see the fault, then CLEAR_FAULT"
    9:
      id: estop
      doc: "torque off, latched: CLEAR_FAULT once the input is closed"
  fault_code:
    0:
      id: none
      doc: "none"
    1:
      id: solver
      doc: "three ticks without a finite answer"
    2:
      id: deadline
      doc: "a tick took longer than it may"
    3:
      id: canary
      doc: "the stack has grown over its end"
    4:
      id: watchdog
      doc: "a part of the main loop did not check in"
    5:
      id: servo
      doc: "a servo reports an error or does not answer"
    6:
      id: servo_map
      doc: "the servos' present positions cannot be taken as goals"
    7:
      id: flash
      doc: "flash reported an error or read back wrong"
    8:
      id: settings
      doc: "settings were stored, but no copy is whole"
    9:
      id: self_test
      doc: "the self-test failed"
    10:
      id: clock
      doc: "not the clock the firmware was built for"
    11:
      id: processor
      doc: "the processor faulted: see BOOT_REPORT"
  reason:
    1:
      id: unsupported
      doc: "this device cannot do that"
    2:
      id: version
      doc: "other major version of the protocol"
    3:
      id: session
      doc: "not the session of the last HELLO"
    4:
      id: state
      doc: "not in this state"
    5:
      id: latched
      doc: "a fault or e-stop is latched: CLEAR_FAULT first"
    6:
      id: estop_open
      doc: "the e-stop input says stop"
    7:
      id: no_poses
      doc: "no good stream of poses"
    8:
      id: poses_too_slow
      doc: "poses further apart than the hold timeout allows"
    9:
      id: name
      doc: "no parameter or preset of that name"
    10:
      id: index
      doc: "beyond the last one"
    11:
      id: entries
      doc: "more or other entries than the parameter has, or none"
    12:
      id: bounds
      doc: "out of bounds"
    13:
      id: not_finite
      doc: "NaN or infinity"
    14:
      id: not_whole
      doc: "a whole number is needed"
    15:
      id: read_only
      doc: "cannot be set"
    16:
      id: disarmed_only
      doc: "only while DISARMED"
    17:
      id: combination
      doc: "each value may be, but not together"
    18:
      id: line_rate
      doc: "does not fit the line: the text has the arithmetic"
    19:
      id: flash
      doc: "flash is full or failed"
    20:
      id: busy
      doc: "still busy with something else: try again"
    21:
      id: servo
      doc: "a servo cannot do that"
    22:
      id: servo_silent
      doc: "a servo does not answer"
    23:
      id: servo_garbled
      doc: "noise comes instead of a servo's answer"
    24:
      id: servo_hardware
      doc: "a servo reports a hardware error: the value"
    25:
      id: servo_beyond
      doc: "no such baud rate or PWM channel here"
  log_level:
    0:
      id: error
      doc: "something is broken"
    1:
      id: warning
      doc: "something should be looked at"
    2:
      id: info
      doc: "good to know"
    3:
      id: debug
      doc: "for developers"
  pose_source:
    0:
      id: unknown
      doc: "not told"
    1:
      id: recorded
      doc: "a track from a file"
    2:
      id: synthetic
      doc: "computed"
    3:
      id: optical
      doc: "an optical tracker"
    4:
      id: vr
      doc: "a VR controller or tracker"
    5:
      id: inertial
      doc: "an inertial tracker"
  angles_flags:
    1:
      id: not_finite
      doc: "the solver gave no finite answer: these are the last tick's"
    2:
      id: limited_angle
      doc: "a joint met its stop"
    4:
      id: limited_acceleration
      doc: "a joint met its bound of acceleration"
    8:
      id: limited_rate
      doc: "a joint met its bound of speed"
    16:
      id: blending
      doc: "a blend is under way"
    32:
      id: predicted
      doc: "the base pose was predicted beyond the newest POSE"
    128:
      id: no_pose
      doc: "no POSE yet in this session: pose_seq and received_ago_us mean nothing"
  pose_log_flags:
    1:
      id: restart
      doc: "the rod was laid straight before this tick"
    2:
      id: gap
      doc: "ticks before this one were not logged: the line was full"
  heartbeat_flags:
    1:
      id: torque
      doc: "the servos have torque"
    2:
      id: estop_open
      doc: "the e-stop input says stop"
    4:
      id: staged
      doc: "values are staged"
    8:
      id: unsaved
      doc: "what is in force is not what flash holds"
    16:
      id: poses_good
      doc: "a good stream of poses: ARM can succeed"
    32:
      id: clock_known
      doc: "a TIMESYNC of this session has told the PC's clock"
  features:
    1:
      id: nodes
      doc: "can send NODES"
    2:
      id: pose_log
      doc: "can send POSE_LOG"
    4:
      id: settings
      doc: "can keep settings"
    8:
      id: estop_input
      doc: "has an e-stop input"
    16:
      id: servo_positions
      doc: "servos tell where they are: arming blends from there"
    32:
      id: servo_assign
      doc: "can give servos other ids"
    64:
      id: bootloader
      doc: "can reboot into a bootloader"
    128:
      id: simulated
      doc: "no rod hangs on it"
  reboot_target:
    0:
      id: firmware
      doc: "the firmware"
    1:
      id: bootloader
      doc: "the bootloader"
  parameter_set:
    0:
      id: in_force
      doc: "what the device runs on"
    1:
      id: staged
      doc: "what COMMIT would apply"
  parameter_kind:
    0:
      id: choice
      doc: "one of several: the text ends in their names, [a|b|c], from 0"
    1:
      id: whole
      doc: "a whole number"
    2:
      id: number
      doc: "a number"
  parameter_flags:
    1:
      id: list
      doc: "one entry a joint or servo; else one"
    2:
      id: disarmed_only
      doc: "COMMIT takes a change only while DISARMED"
    4:
      id: read_only
      doc: "cannot be set"
    8:
      id: kept
      doc: "SAVE writes it to flash"
  reset_cause:
    0:
      id: power
      doc: "power came"
    1:
      id: pin
      doc: "reset pin"
    2:
      id: software
      doc: "REBOOT"
    3:
      id: watchdog
      doc: "the watchdog was not fed"
    4:
      id: processor
      doc: "the fault handler restarted: pc, lr and cfsr tell where"
  clock_kind:
    0:
      id: crystal
      doc: "crystal, through the PLL"
    1:
      id: internal_pll
      doc: "the crystal failed: internal oscillator, through the PLL"
    2:
      id: internal
      doc: "the PLL failed as well: internal oscillator"
    3:
      id: emulator
      doc: "an emulated board"
    4:
      id: host
      doc: "a simulator's"
  settings_origin:
    0:
      id: never_saved
      doc: "defaults: nothing was ever saved"
    1:
      id: newest
      doc: "the newest record"
    2:
      id: older
      doc: "recovered from an older copy: the newest record is damaged"
    3:
      id: lost
      doc: "defaults: records were found, none of them whole"
  boot_flags:
    1:
      id: estop_ignored
      doc: "there is no e-stop input here (emulator, host)"
  object_kind:
    0:
      id: none
      doc: "nothing"
    1:
      id: plane
      doc: "a half-space: all below its own z = 0 is solid"
    2:
      id: sphere
      doc: "a ball"
    3:
      id: capsule
      doc: "a rod with round ends"
    4:
      id: box
      doc: "a box with rounded edges"
  # end enums
