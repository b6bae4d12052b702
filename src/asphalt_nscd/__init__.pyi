from asphalt_nscd.api.contacts import solve_contacts as solve_contacts
from asphalt_nscd.api.diagnosis import Diagnosis as Diagnosis
from asphalt_nscd.api.diagnosis import Draws as Draws
from asphalt_nscd.api.diagnosis import diagnose as diagnose
from asphalt_nscd.api.exporting import ExportSettings as ExportSettings
from asphalt_nscd.api.exporting import export as export
from asphalt_nscd.api.laws import Law as Law
from asphalt_nscd.api.laws import fit as fit
from asphalt_nscd.api.reading import read as read
from asphalt_nscd.files.errors import InputError as InputError

__version__: str
