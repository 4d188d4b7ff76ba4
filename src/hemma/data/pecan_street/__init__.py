"""Pecan Street Dataport files: the paper's kind of data, fetched by universities, shared by nobody."""

from hemma.data.pecan_street.listing import PecanStreetHome, list_pecan_street_homes
from hemma.data.pecan_street.reader import PecanStreetOptions, read_pecan_street

__all__ = ["PecanStreetHome", "PecanStreetOptions", "list_pecan_street_homes", "read_pecan_street"]
