"""All that an experiment depends on besides its traces, in one frozen tree."""

from dataclasses import dataclass, field, replace

from hemma.data import Tariff
from hemma.forecasting.shape import ShapeForecast
from hemma.home import Battery, ComfortBand, ExplicitThermalModel, Home, Hvac
from hemma.home.checks import require
from hemma.identification.excitation import Excitation
from hemma.identification.settings import IdentificationSettings
from hemma.irl.airl import AIRLSettings
from hemma.irl.cloning import CloningSettings
from hemma.irl.maxent import MaxEntSettings
from hemma.optimisation.hierarchy import HierarchySettings
from hemma.rl.ddpg import DDPGSettings
from hemma.rl.explicit import ExplicitSettings
from hemma.rl.policies.action_space import ActionSpace
from hemma.rl.policies.spaces import FRACTIONS, SPACES
from hemma.rl.ppo import PPOSettings
from hemma.settings.faults import FaultSettings


@dataclass(frozen=True)
class DataEfficiency:
    """How the method fares with more and fewer days of demonstrations (Figs. 3a and 3b of the paper)."""

    days: tuple[int, ...] = (1, 3, 7, 15, 30, 60)
    """Lengths, each from the first training day on; those longer than the training period are left out."""
    seeds: int = 3
    """Runs of each length."""

    def __post_init__(self):
        """Refuse lengths and numbers of runs that cannot be."""
        require("data_efficiency", all(days >= 1 for days in self.days), "days of at least 1", self.days)
        require("data_efficiency", len(set(self.days)) == len(self.days), "different days", self.days)
        require("data_efficiency", self.seeds >= 1, "seeds >= 1", self.seeds)


@dataclass(frozen=True)
class ComfortPrices:
    """How beta_T of the explicit reward is chosen for each method: by a sweep on the training period."""

    multiples: tuple[float, ...] = (0.25, 1.0, 4.0, 16.0)
    """Values to try, in multiples of what the HVAC at full power costs in a slot of mean buying price."""
    seeds: int = 2
    """Runs of each."""
    held_out: float = 0.25
    """Share of the training period, its end, that the runs do not see and are judged on."""
    tolerance: float = 0.02
    """Largest mean deviation there that counts as comfort kept [degC]; the least regret among those wins."""

    def __post_init__(self):
        """Refuse values that cannot be."""
        positive = bool(self.multiples) and all(value > 0 for value in self.multiples)
        require("comfort_price", positive, "multiples > 0", self.multiples)
        require("comfort_price", self.seeds >= 1, "seeds >= 1", self.seeds)
        require("comfort_price", 0 < self.held_out < 1, "0 < held_out < 1", self.held_out)


@dataclass(frozen=True)
class ParetoSettings:
    """Cost against comfort, for the report."""

    relaxations: tuple[float, ...] = (-0.5, 0.5, 1.0)
    """Widenings of the expert's comfort band at the edge where energy is saved [degC]; empty: none."""
    seeds: int = 1
    """Runs of HA-1 with each."""

    def __post_init__(self):
        """Refuse values that cannot be."""
        require(
            "pareto",
            len(set(self.relaxations)) == len(self.relaxations),
            "different relaxations",
            self.relaxations,
        )
        require("pareto", self.seeds >= 1, "seeds >= 1", self.seeds)


@dataclass(frozen=True)
class DefaultController:
    """How the default controller's forecast is made and chosen."""

    shape: ShapeForecast = field(default_factory=ShapeForecast)
    """The forecast that learns the shape of the day."""
    refitted: int = 7
    """Days after which the forecasts are fitted again, to all that has happened until then."""
    margin: float = 0.2
    """How much less regret, as a share, makes up for a later place in the order of preference."""
    judged: float = 0.5
    """Share of the training period, its end, on which the forecasts are judged."""
    folds: int = 2
    """Parts that are judged one by one, each planned by forecasts fitted to the days before it."""
    published_at: float = 14.0
    """Hour of the day at which tomorrow's prices are published; only `default published` knows them."""

    def __post_init__(self):
        """Refuse values that cannot be."""
        require("default", self.refitted >= 1, "refitted >= 1", self.refitted)
        require("default", 0 <= self.margin < 1, "0 <= margin < 1", self.margin)
        require("default", 0 < self.judged < 1, "0 < judged < 1", self.judged)
        require("default", self.folds >= 1, "folds >= 1", self.folds)
        require("default", 0 <= self.published_at <= 24, "published_at from 0 to 24", self.published_at)


@dataclass(frozen=True)
class Experiment:
    """The paper's experiment; every default that the paper does not print is explained in docs/paper.md."""

    battery: Battery = field(default_factory=Battery)
    building: ExplicitThermalModel = field(default_factory=ExplicitThermalModel)
    """The building that is simulated, its inertia for one hour whatever the slot length of the traces."""
    hvac: Hvac = field(default_factory=Hvac)
    comfort: ComfortBand = field(default_factory=ComfortBand)
    initial_temperature: float = 23.0
    """T_in at the first slot of any period [degC]."""
    disturbance_deviation: float = 0.0
    """Standard deviation of the thermal disturbance in identification and training [degC]; 0 in the test."""
    tariff: Tariff = field(default_factory=Tariff)
    """From wholesale prices to what the embedded homes pay; a file of traces brings its own prices."""
    currency: str = "$"
    """Of the prices: a sign or a code such as SEK."""
    pv_scale: float = 1.0
    """PV generation of the traces is multiplied by this."""
    excitation: Excitation = field(default_factory=Excitation)
    identification: IdentificationSettings = field(default_factory=IdentificationSettings)
    expert: HierarchySettings = field(default_factory=HierarchySettings)
    airl: AIRLSettings = field(default_factory=AIRLSettings)
    ppo: PPOSettings = field(default_factory=PPOSettings)
    """Of every policy that imitates and is improved by PPO; AIRL and GAIL set the number of rollouts."""
    explicit: ExplicitSettings = field(default_factory=ExplicitSettings)
    """Of PPO on the explicit reward, which has a PPO of its own."""
    ddpg: DDPGSettings = field(default_factory=DDPGSettings)
    maxent: MaxEntSettings = field(default_factory=MaxEntSettings)
    cloning: CloningSettings = field(default_factory=CloningSettings)
    comfort_price: ComfortPrices = field(default_factory=ComfortPrices)
    pareto: ParetoSettings = field(default_factory=ParetoSettings)
    default: DefaultController = field(default_factory=DefaultController)
    faults: FaultSettings = field(default_factory=FaultSettings)
    """Of `hemma robustness`."""
    actions: str = FRACTIONS.name
    """What policies decide on, DDPG's aside: `fractions` of what is feasible, or the `stored value` of
    a kWh; see docs/stored-value.md."""
    forecast_horizon: float = 36.0
    """How far ahead the rolling planners (MPC) look [h]."""
    learned: tuple[str, ...] | None = None
    """Learned methods to run; null: HA-1, HA-2, GAIL, MaxEnt IRL, MaxEnt IRL neural, BC, PPO and DDPG. Each
    may see more, such as `HA-1 past` or `PPO published`; docs/observations.md has all names."""
    seeds: int = 3
    """Runs of each learned method, with the seeds 0, 1, ..."""
    demonstration_days: int = 15
    """Days of demonstrations of HA-1, GAIL and BC, the first of the training period."""
    long_demonstration_days: int = 60
    """Days of demonstrations of HA-2 and MaxEnt IRL; the whole training period where it is shorter."""
    data_efficiency: DataEfficiency = field(default_factory=DataEfficiency)

    def __post_init__(self):
        """Refuse numbers of runs and days that cannot be."""
        for name in ("seeds", "demonstration_days", "long_demonstration_days"):
            require("experiment", getattr(self, name) >= 1, f"{name} >= 1", getattr(self, name))
        names = self.learned or ()
        require("experiment", len(set(names)) == len(names), "different methods as learned", names)
        require("experiment", self.forecast_horizon > 0, "forecast_horizon > 0", self.forecast_horizon)
        require("experiment", self.actions in SPACES, f"actions one of {', '.join(SPACES)}", self.actions)
        require("experiment", self.pv_scale >= 0, "pv_scale >= 0", self.pv_scale)

    @property
    def space(self) -> ActionSpace:
        """What the policies decide on."""
        return SPACES[self.actions]

    def home(self, slot_length: float) -> Home:
        """The home for slots of ``slot_length`` [h], the building converted exactly."""
        return Home(
            battery=self.battery,
            thermal_model=self.building.at_slot_length(slot_length),
            hvac=self.hvac,
            comfort=self.comfort,
            slot_length=slot_length,
            initial_temperature=self.initial_temperature,
            disturbance_deviation=self.disturbance_deviation,
        )


def quick(experiment: Experiment) -> Experiment:
    """The same experiment in a few minutes: every stage, but too little training to quote."""
    seeds = min(experiment.seeds, 2)
    return replace(
        experiment,
        seeds=seeds,
        airl=replace(experiment.airl, iterations=min(experiment.airl.iterations, 200)),
        maxent=replace(experiment.maxent, iterations=min(experiment.maxent.iterations, 100)),
        explicit=replace(experiment.explicit, iterations=min(experiment.explicit.iterations, 100)),
        ddpg=replace(experiment.ddpg, iterations=min(experiment.ddpg.iterations, 100)),
        comfort_price=replace(experiment.comfort_price, multiples=(1.0, 16.0), seeds=1),
        data_efficiency=replace(experiment.data_efficiency, days=(3,), seeds=seeds),
        pareto=replace(experiment.pareto, relaxations=(0.5,), seeds=seeds),
    )
