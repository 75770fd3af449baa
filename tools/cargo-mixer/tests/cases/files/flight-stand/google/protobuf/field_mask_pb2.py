from types import SimpleNamespace as FieldMask
