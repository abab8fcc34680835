"""All known instructions, one row each, with their certainty.

A row has: ``AC``, the high byte of the function's word; the text; the operands in the order of their words,
with their use; the grade (see ``grades``). A comment has the evidence, if it is not a printout of the
vendor's software.

If only the number of operands is known, they have no names. Words that are not in the table are kept as
words.
"""

from __future__ import annotations

from typing import Final

from fatektool.ladder.forms import Form, Shape
from fatektool.ladder.grades import Grade
from fatektool.ladder.operands import OperandForm, OperandKind, OperandUse

A, B, C = Grade.A, Grade.B, Grade.C

FIRST: Final = OperandForm(constant=1)
SECOND: Final = OperandForm(constant=2)
FIRST_LONG: Final = OperandForm(constant=1, words=2, registers=2)
SECOND_LONG: Final = OperandForm(constant=2, words=2, registers=2)
FIRST_FLOAT: Final = OperandForm(OperandKind.FLOAT, constant=1, words=2, registers=2)
SECOND_FLOAT: Final = OperandForm(OperandKind.FLOAT, constant=2, words=2, registers=2)
FLOAT_IN_ONE: Final = OperandForm(registers=2)
SOURCE: Final = OperandForm()
TARGET: Final = OperandForm(use=OperandUse.WRITE)
TWO_TARGETS: Final = OperandForm(use=OperandUse.WRITE, registers=2)
FOUR_TARGETS: Final = OperandForm(use=OperandUse.WRITE, registers=4)
CHANGED: Final = OperandForm(use=OperandUse.CHANGE)
TABLE_IN: Final = OperandForm(use=OperandUse.READ_ON)
TABLE_OUT: Final = OperandForm(use=OperandUse.WRITE_ON)
TABLE: Final = OperandForm(use=OperandUse.CHANGE_ON)
NUMBER: Final = OperandForm(OperandKind.NUMBER)
FIRST_NUMBER: Final = OperandForm(OperandKind.NUMBER, constant=1)
CODE: Final = OperandForm(OperandKind.CODE, OperandUse.NOTHING)
BIT_IN: Final = OperandForm(OperandKind.BIT)
BIT_OUT: Final = OperandForm(OperandKind.BIT, OperandUse.WRITE)
BIT_CHANGED: Final = OperandForm(OperandKind.BIT, OperandUse.CHANGE)
MUTE: Final = OperandForm(OperandKind.MUTE, OperandUse.NOTHING)
TEXT: Final = OperandForm(OperandKind.TEXT, OperandUse.NOTHING)

EITHER: Final = "4567"
PULSED: Final = "0123"


def _contacts() -> list[Form]:
    """One word: the low byte has the op and the address's highest digit, the high byte the rest."""
    ops = {
        0x0: ("OUTR", A),
        0x1: ("OUTS", A),
        0x4: ("ORG", A),
        0x5: ("ORG NOT", A),
        0x6: ("LD", A),
        0x7: ("LD NOT", A),
        0x8: ("AND", A),
        0x9: ("AND NOT", A),
        0xA: ("OR", A),
        0xB: ("OR NOT", A),
        0xC: ("OUT", A),
        0xD: ("OUT NOT", B),  # from published notes of single changes
    }
    forms = []
    for op, (name, grade) in ops.items():
        begins = op in {0x4, 0x5}
        writes = op in {0x0, 0x1, 0xC, 0xD}
        shown = f"{name} {{bit}}"
        forms.append(
            Form(Shape.CONTACT, shown, (op << 4,), (0xFF0F,), grade=grade, begins=begins, writes=writes)
        )
        if writes:
            continue
        edge = "TD" if op & 1 else "TU"  # what is NOT without the prefix is the falling edge with it
        plain = name.removesuffix(" NOT")
        # Printed of ORG, AND and OR; LD from its likeness to them.
        sure = B if plain == "LD" else A
        forms.append(
            Form(
                Shape.CONTACT,
                f"{plain} {edge} {{bit}}",
                (0x00E0, op << 4),
                (0, 0xFF0F),
                grade=sure,
                begins=begins,
            )
        )
    return forms


_MARKS: Final = (
    Form(Shape.MARK, "ANDLD", (0x00E2,), (0,)),
    Form(Shape.MARK, "ORLD", (0x00E4,), (0xFF00,)),  # the high byte only says how it is drawn
    Form(Shape.MARK, "TU", (0x00EA,), (0,), grade=B),  # edges of the line so far: notes of single changes
    Form(Shape.MARK, "TD", (0x00E8,), (0,), grade=B),
    Form(Shape.MARK, "INV", (0x00EC,), (0,), grade=B),
    # Drawing alone: the vendor's program prints nothing for these.
    Form(Shape.MARK, "", (0x81EE,), (0,)),
    Form(Shape.MARK, "", (0x82EE,), (0,)),
    Form(Shape.MARK, "", (0x83EE,), (0,)),
)


def _function(
    code: int,
    shown: str,
    *parts: OperandForm,
    grade: Grade = A,
    usual: str = EITHER,
    pulse: str = "",
    begins: bool = False,
) -> Form:
    pulse = pulse or (PULSED if "{P}" in shown else "")
    return Form(
        Shape.FUNCTION, shown, (code << 8 | 0xF0,), (0x000F,), parts, grade, usual, pulse, begins=begins
    )


_FUNCTIONS: Final = (
    # Coils as functions. C: plain; 8, without bit 2: the pulse form. The lowest bit of RST: a register.
    _function(0x82, "SET{brackets} {0}", BIT_OUT, usual="C", pulse="8"),
    # Timers: the code says the base; it has the preset, then the timer. The lowest bit: a constant preset.
    _function(0x80, "{1} .01 {0}", FIRST, TARGET, usual="CD"),
    _function(0x81, "{1} .1 {0}", FIRST, TARGET, usual="CD"),
    _function(0xBE, "{1} {0}", FIRST, TARGET, usual="CD"),
    _function(0x40, "{1} {0}", FIRST, CHANGED, grade=B, usual="89"),  # notes; what bit 3 says is not known
    _function(0x41, "FUN 87 T.01S CV:{1} PV:{0}", FIRST, CHANGED, grade=C, usual="CDEF"),  # as 43, 16 bits
    _function(0x42, "FUN 88 T.1S CV:{1} PV:{0}", FIRST, CHANGED, grade=C, usual="CDEF"),
    _function(0x43, "FUN 89D T1S CV:{1} PV:{0}", FIRST_LONG, CHANGED, grade=B, usual="CDEF"),
    # Arithmetic and moves.
    _function(0x62, "FUN 11{P} (+) Sa:{0} Sb:{1} D:{2}", FIRST, SECOND, TARGET),
    _function(0x64, "FUN 12{P} (-) Sa:{0} Sb:{1} D:{2}", FIRST, SECOND, TARGET, grade=B),
    _function(0x66, "FUN 13{P} (*) Sa:{0} Sb:{1} D:{2}", FIRST, SECOND, TWO_TARGETS, grade=C),
    _function(
        0x67, "FUN 13D{P} (*) Sa:{1} Sb:{2} D:{3}", MUTE, FIRST_LONG, SECOND_LONG, FOUR_TARGETS, grade=B
    ),
    _function(0x68, "FUN 14{P} (/) Sa:{0} Sb:{1} D:{2}", FIRST, SECOND, TWO_TARGETS, grade=B),
    _function(0x6A, "FUN 17{P} CMP Sa:{0} Sb:{1}", FIRST, SECOND, MUTE, grade=B),
    _function(0x6B, "FUN 17D{P} CMP Sa:{1} Sb:{2}", MUTE, FIRST_LONG, SECOND_LONG, grade=B),
    _function(0x96, "FUN 15{P} (+1) {0}", CHANGED, usual="4"),
    _function(0x98, "FUN 16{P} (-1) {0}", CHANGED, grade=B, usual="4"),
    _function(0xAC, "FUN 08{P} MOV S:{0} D:{1}", FIRST, TARGET, usual="45"),
    _function(0xAD, "FUN 08D{P} MOV S:{0} D:{1}", FIRST_LONG, TWO_TARGETS, grade=B),
    _function(0xC6, "FUN 18{P} AND Sa:{0} Sb:{1} D:{2}", FIRST, SECOND, TARGET, grade=B),
    _function(0x9E, "FUN 28{P} ABS {0}", CHANGED, grade=C),
    # Bits and tables.
    _function(0xBA, "FUN 40{P} BITRD S:{0} N:{1}", FIRST, NUMBER, grade=B),
    _function(0x44, "FUN 41{P} BITWR D:{1} N:{0}", FIRST_NUMBER, CHANGED, grade=B),
    _function(0xB2, "FUN 43{P} NBM {0} {1} {2}", FIRST_NUMBER, TABLE, TABLE, grade=C),
    _function(0xCE, "FUN 103{P} BT_M Ts:{0} Td:{1} L:{2}", TABLE_IN, TABLE_OUT, NUMBER, grade=C),
    _function(0xF8, "FUN 107{P} T_FIL Rs:{0} Td:{1} L:{2}", FIRST, TABLE_OUT, NUMBER, grade=C),
    _function(
        0x47,
        "FUN 108D{P} T_SHF IW:{0} Ts:{1} Td:{2} L:{3} OW:{4}",
        FIRST_LONG,
        TABLE_IN,
        TABLE_OUT,
        NUMBER,
        TWO_TARGETS,
        grade=C,
    ),
    _function(
        0x48,
        "FUN 110{P} QUEUE IW:{0} QU:{1} L:{2} Pr:{3} OW:{4}",
        FIRST,
        TABLE,
        NUMBER,
        CHANGED,
        TARGET,
        grade=B,
    ),
    _function(
        0x49,
        "FUN 110D{P} QUEUE IW:{0} QU:{1} L:{2} Pr:{3} OW:{4}",
        FIRST_LONG,
        TABLE,
        NUMBER,
        CHANGED,
        TARGET,
        grade=B,
    ),
    _function(0x5C, "FUN 114{P} Z-WR D:{1} N:{0}", FIRST_NUMBER, BIT_OUT, grade=C),
    _function(
        0xF0,
        "FUN 60{P} ->ASC '{1}{2}{3}{4}{5}{6}' D:{7}",
        MUTE,
        *[TEXT] * 6,
        TABLE_OUT,
        grade=C,
    ),
    # Edges and flip-flops.
    _function(0xE4, "FUN 10 TOGG {0}", BIT_CHANGED, grade=B, usual="8"),
    _function(0xF6, "FUN 4 DIFU {0}", BIT_OUT, grade=C, usual="8"),
    # Analog, counting, positions. The lowest bits of 1A and D0 are Ps: 0 and 1 are printed, 2 and 3 alike.
    _function(0x5A, "FUN 32{P} ADCNV Pl:? S:{1} N:{0} D:{2}", FIRST_NUMBER, TABLE_IN, TABLE_OUT, grade=C),
    _function(
        0x7C,
        "FUN 33{P} LCNV Md:{0} S:{1} Ts:{2} D:{3} L:{4}",
        FIRST_NUMBER,
        TABLE_IN,
        TABLE_IN,
        TABLE_OUT,
        NUMBER,
        grade=B,
    ),
    _function(0xF3, "FUN 82 PWM To:{0} Tp:{1} OT:{2}", FIRST, SECOND, BIT_OUT, grade=B),
    _function(
        0x54,
        "FUN 86 TPCTL Md:{one} Yn:{0} Sn:{1.high} Zn:{1.low} Sv:{2} Os:{3} PR:{4} IR:{5} DR:{6} OR:{7}"
        " WR:{8}",
        BIT_OUT,
        CODE,
        *[TABLE_IN] * 5,
        *[TABLE_OUT] * 2,
        grade=B,
    ),
    _function(0x00, "FUN 07 UDCTR CV:{1} PV:{0}", FIRST, CHANGED, grade=B, usual="01"),
    _function(0xE5, "FUN 92 HSCTR {0}", CODE, grade=B, usual="4"),
    _function(0xE7, "FUN 93D HSCTW S:{1} CN:{0} D:CV/PV?", CODE, FIRST_LONG, grade=B),
    _function(
        0x7B, "FUN 139 HSPWM PW/OP/RS:{0} PN:{1} OR:{2} WR:{3}", CODE, SOURCE, SOURCE, TABLE_OUT, grade=B
    ),
    _function(0x1A, "FUN 140 HSPSO Ps:{two} SR:{0} WR:{1}", TABLE_IN, TABLE_OUT, usual="45"),
    _function(0xD0, "FUN 141 MPARA Ps:{two} SR:{0}", TABLE_IN, usual="01"),
    # Communication. The low nibble of M-BUS is the port.
    _function(0x1B, "FUN 150 M-BUS Pt:{three} SR:{0} WR:{1}", TABLE_IN, TABLE_OUT, grade=B, usual="01234"),
    _function(
        0x1C,
        "FUN 151 CLINK Pt:{2.high}? Md:{2.low}? SR:{0} WR:{1}",
        TABLE_IN,
        TABLE_OUT,
        CODE,
        grade=B,
        usual="0",
    ),
    # The order of the program. Their layout is certain: in each file the next instruction is read right.
    _function(0x84, "STP {0}", BIT_IN, grade=B, usual="C", begins=True),
    _function(0xF1, "STP {0}", BIT_IN, grade=B, usual="C", begins=True),
    _function(0x86, "TO {0}", BIT_OUT, grade=B, usual="C"),
    _function(0x87, "FROM {0}", BIT_IN, grade=B, usual="C", begins=True),
    _function(0x85, "STPEND", grade=B, usual="C", begins=True),
    _function(0x8D, "FUN 67 CALL {1}{2}{3}", MUTE, *[TEXT] * 3, grade=B),
    _function(0x8E, "FUN 68 RTS", grade=B, usual="4"),
    _function(0xFE, "END", grade=B, usual="C"),
)

RESET: Final = Form(
    Shape.FUNCTION, "RST{brackets} {0}", (0xC4F0,), (0x000E,), (BIT_OUT,), usual="C", pulse="8"
)
RESET_REGISTER: Final = Form(
    Shape.FUNCTION, "RST{brackets} {0}", (0xC4F1,), (0x000E,), (TARGET,), usual="D", pulse="9"
)
LABEL: Final = Form(
    Shape.LABEL, "FUN 65 LBL {char}{0}{1}{2}", (0x00EF,), (0xFF00,), (TEXT,) * 3, grade=B, begins=True
)


def _extended() -> list[Form]:
    """7F and a second word: comparisons of 16 or 32 bits, and floats."""
    signs = {170: ("=", B), 171: (">", A), 172: ("<", A), 173: ("<>", B), 174: (">=", A), 175: ("=<", B)}
    places = {0x15: ("ORGF", A), 0x1B: ("LDF", C), 0x21: ("ANDF", A), 0x27: ("ORF", C)}
    comparisons = [
        _two_words(
            (base + function - 170) << 8 | wide,
            f"{place} {function}{'D' if wide else ''} {sign} Sa:{{0}} Sb:{{1}}",
            *((FIRST_LONG, SECOND_LONG) if wide else (FIRST, SECOND)),
            grade=max(place_grade, grade, B if wide else A),
            begins=place == "ORGF",
        )
        for base, (place, place_grade) in places.items()
        for function, (sign, grade) in signs.items()
        for wide in (False, True)
    ]
    floats = ((2, "FADD"), (3, "FSUB"), (4, "FMUL"), (5, "FDIV"))
    return [
        *comparisons,
        # Bit 1 of the low nibble: the integer has 32 bits.
        _two_words(0x0000, "FUN 200{D}{P} I->F S:{0} D:{1}", FIRST_LONG, TWO_TARGETS, grade=B),
        _two_words(0x0100, "FUN 201{D}{P} F->I S:{0} D:{1}", FLOAT_IN_ONE, TWO_TARGETS, grade=B),
        *(
            _two_words(
                code << 8,
                f"FUN {200 + code}{{P}} {name} Sa:{{0}} Sb:{{1}} D:{{2}}",
                FIRST_FLOAT,
                SECOND_FLOAT,
                TWO_TARGETS,
                grade=B,
            )
            for code, name in floats
        ),
        # Its limits come before what is held against them.
        _two_words(
            0x0700, "FUN 207{P} FZCP S:{2} Su:{0} Sl:{1}", FIRST_FLOAT, SECOND_FLOAT, FLOAT_IN_ONE, grade=B
        ),
    ]


def _two_words(second: int, shown: str, *parts: OperandForm, grade: Grade, begins: bool = False) -> Form:
    pulse = PULSED if "{P}" in shown else ""
    return Form(
        Shape.FUNCTION, shown, (0x7FF0, second), (0x000F, 0), parts, grade, EITHER, pulse, begins=begins
    )


FORMS: Final = (*_contacts(), *_MARKS, *_FUNCTIONS, RESET, RESET_REGISTER, LABEL, *_extended())
"""All forms. No word is the head of two."""
