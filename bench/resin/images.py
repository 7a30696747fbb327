"""Compares the images of two jobs."""

import zipfile
from dataclasses import dataclass

from tests.app.png_image import Image

LOOKED_AT = 6  # number of images; decoding one takes a second
MOST_APART = 1e-3  # fraction of the covered area; a shift by a tenth of a pixel is more if the outline is long


@dataclass(frozen=True)
class Agreement:
    images: int
    expected: int
    largest: int = 0  # difference of a pixel, of 255
    apart: float = 0.0  # sum of all differences / covered area
    same_size: bool = True

    @property
    def good(self):
        return self.as_many and self.same_size and self.apart <= MOST_APART

    @property
    def as_many(self):
        """Returns whether the numbers of layers agree, except for a thin top layer that some programs omit."""
        return abs(self.images - self.expected) <= 1

    def text(self):
        if not self.as_many:
            return f"{self.images} images instead of {self.expected}"
        if not self.same_size:
            return "pictures of another size"
        return f"{self.images}; pixels differ by at most {self.largest} of 255, in all by {self.apart:.1g} of the area"


def names(archive):
    """Returns the names of the layers' images; images in folders are thumbnails."""
    return sorted(name for name in archive.namelist() if name.endswith(".png") and "/" not in name)


def compare(ours, theirs):
    """Compares the archives at these paths in some layers. The last layer is not compared: if a part ends within it,
    programs cut it at other heights."""
    with zipfile.ZipFile(ours) as our_job, zipfile.ZipFile(theirs) as their_job:
        our_names, their_names = names(our_job), names(their_job)
        numbers = len(their_names), len(our_names)
        if not Agreement(*numbers).as_many or not all(numbers):
            return Agreement(*numbers, same_size=False)
        last = max(min(numbers) - 2, 0)
        largest = total = covered = 0
        for i in sorted({k * last // (LOOKED_AT - 1) for k in range(LOOKED_AT)}):
            our, their = Image(our_job.read(our_names[i])), Image(their_job.read(their_names[i]))
            if (our.width, our.height) != (their.width, their.height):
                return Agreement(*numbers, same_size=False)
            covered += our.covered()
            for mine, other in zip(our.rows, their.rows):
                if mine != other:
                    differences = [abs(a - b) for a, b in zip(mine, other)]
                    largest = max(largest, *differences)
                    total += sum(differences) / 255
        return Agreement(*numbers, largest, total / covered if covered else float(total > 0))
