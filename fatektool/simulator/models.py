"""The PLCs that can be simulated: their status codes and memory sizes.

The values of ``fbe-28mc`` are those of the example in the FACON paper (section 4.2, command 53), those of
``fbs-20mc`` the ones in the paper's FBs edition. The other models have the same, except main unit, points and
ladder size, as in their names. Brief status byte 2 is from the table of command 40; the FBs example has 40H
there, which is not in that table. The M-series paper gives no sizes: ``m-series`` has those of an FBs, with
its file registers F.

FBs and B1 models have a program image of their family, whose header is part of the ladder size, and refuse
the pages after its end: ``fbs-24mc`` returns only its code, the others everything. This is assumed: no paper
says that an FBs answers 4F at all.

``dataclasses.replace(model, ladder_words=...)`` makes a model with another ladder size.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from fatektool.simulator.program.fbs_program import CODE, FbsImage

MAX_LADDER_WORDS = 0xFFFF
WORDS_PER_PAGE = 64
PAGE_BYTES = 2 * WORDS_PER_PAGE


@dataclass(frozen=True, slots=True)
class Model:
    """One model of PLC; counts are numbers of elements, with addresses from 0 to the count - 1.

    Args:
        name: in lower case, as on the command line.
        status2: byte 2 of the brief status: ladder size class.
        status3: byte 3 of the brief status: reserved.
        unit_type: byte 2 of the detailed status: 00 MA/MU, 01 MC.
        points_code: byte 3 of the detailed status; FB and FBs number it differently.
        os_version: one digit in each nibble: 31H is 3.1.
        ladder_words: size of the program memory, 1 to 65535 words of 16 bits.
        f_registers: file registers; 0 if the model has none. Not in the detailed status.
        image: the program image of an FBs; None for the paper's header.
        pages: the number of program pages, if a program has another number than usual.
    """

    name: str
    status2: int
    status3: int
    unit_type: int
    points_code: int
    os_version: int
    ladder_words: int
    discrete_inputs: int
    discrete_outputs: int
    analog_inputs: int
    analog_outputs: int
    m_relays: int
    s_relays: int
    l_relays: int
    r_registers: int
    d_registers: int
    timers: int
    counters: int
    f_registers: int = 0
    image: FbsImage | None = None
    pages: int | None = None

    def __post_init__(self) -> None:
        if not 1 <= self.ladder_words <= MAX_LADDER_WORDS:
            raise ValueError(f"a ladder has 1 to {MAX_LADDER_WORDS} words, not {self.ladder_words}")

    @property
    def page_count(self) -> int:
        """Program pages: one more than the ladder's, rounded up; none more for an FBs image."""
        if self.pages is not None:
            return self.pages
        pages = -(-self.ladder_words // WORDS_PER_PAGE)
        return min(self.image.pages, pages) if self.image is not None and self.has_fbs_image else pages + 1

    @property
    def has_fbs_image(self) -> bool:
        """True if its program is an FBs image; a very small ladder has no space for one."""
        return self.image is not None and self.ladder_words > CODE


_FBE_28MC = Model(
    name="fbe-28mc",
    status2=0x54,
    status3=0x00,
    unit_type=0x01,
    points_code=0x02,
    os_version=0x31,
    ladder_words=13184,
    discrete_inputs=256,
    discrete_outputs=256,
    analog_inputs=100,
    analog_outputs=100,
    m_relays=2002,
    s_relays=1000,
    l_relays=0,
    r_registers=8072,
    d_registers=3072,
    timers=256,
    counters=256,
)
_FBE_8K = replace(_FBE_28MC, name="fbe-20mc", status2=0x53, points_code=0x01, ladder_words=8192)
_FBS_20MC = replace(
    _FBE_28MC,
    name="fbs-20mc",
    status2=0x40,
    os_version=0x40,
    ladder_words=32768,
    d_registers=4096,
    f_registers=8192,
    image=FbsImage("0003", 0x4F00, 512),
)

DEFAULT_MODEL = "fbe-28mc"

MODELS: dict[str, Model] = {
    model.name: model
    for model in (
        replace(_FBE_8K, name="fb-20mc", status2=0xFF, os_version=0x30),
        replace(_FBE_8K, name="fb-40mc", status2=0xFF, points_code=0x03, os_version=0x30),
        replace(_FBE_8K, name="fb-40mu", status2=0xFF, unit_type=0x00, points_code=0x03, os_version=0x30),
        _FBE_8K,
        _FBE_28MC,
        replace(_FBE_28MC, name="fbe-40mc", points_code=0x03),
        replace(_FBE_8K, name="fbn-20mc", status2=0x55),
        replace(_FBE_28MC, name="fbn-40mc", status2=0x56, points_code=0x03),
        _FBS_20MC,
        replace(_FBS_20MC, name="fbs-24mc", points_code=0x03, image=FbsImage("0003", 0x4F00, 320)),
        replace(_FBS_20MC, name="fbs-60mc", points_code=0x06),
        replace(
            _FBS_20MC,
            name="b1-14mc",
            points_code=0x01,
            ladder_words=8192,
            image=FbsImage("0110", 0x1F00, 128),
        ),
        replace(_FBS_20MC, name="m-series", image=None),
    )
}
