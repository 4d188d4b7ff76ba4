"""Prices that are published ahead, as on day-ahead markets: known until the end of the published day."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool

from hemma.forecasting.outlook import DAY, Forecaster, Outlook, perfect
from hemma.home.checks import require
from hemma.types import Exogenous


@dataclass(frozen=True)
class PublishedPrices:
    """Another forecast, with true prices until midnight, and from ``published_at`` on until the next one."""

    otherwise: Forecaster
    """What is believed of all else, and of prices beyond."""
    published_at: float = 14.0
    """Hour of the day from which tomorrow's prices are known. ERCOT's day-ahead market clears by 13:30
    (Nodal Protocols, section 4), Nord Pool's at about 12:45."""

    def __post_init__(self):
        """Refuse an hour that no day has."""
        require("published prices", 0 <= self.published_at <= DAY, "an hour of the day", self.published_at)

    def __call__(self, outlook: Outlook) -> Exogenous:
        """The forecast with the published prices in it."""
        ahead, true, known = self.otherwise(outlook), perfect(outlook), self._known(outlook)
        return replace(
            ahead,
            buying_price=np.where(known, true.buying_price, ahead.buying_price),
            selling_price=np.where(known, true.selling_price, ahead.selling_price),
        )

    def _known(self, outlook: Outlook) -> Bool[np.ndarray, "slots horizon"]:
        clock, targets = outlook.clock(), outlook.targets()
        midnights = np.cumsum(np.diff(clock, prepend=clock[0]) < 0)
        now = targets[:, :1]
        last = midnights[now] + (clock[now] >= self.published_at)
        return midnights[targets] <= last
